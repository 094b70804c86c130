"""A black box's files: gzip of JSON lines, a header first and then a line a message, in the order of time."""

import base64
import gzip
import os
import time
import zlib
from collections.abc import Iterable, Iterator
from datetime import UTC, datetime
from math import isfinite
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
from msgspec import UNSET, Struct, UnsetType

from zteleop.bus import codec
from zteleop.bus.escape import printable
from zteleop.bus.tap import Raw
from zteleop.bus.topics import topic_of
from zteleop.control.proof import Proof
from zteleop.errors import ConfigError, MessageError

LONG_AGO = -1e12
"""s"""
SUFFIX = ".jsonl.gz"
KEPT = 5
"""files of each reason"""
LEVEL = 3
"""of gzip: a third of the time of its own choice, for a tenth more of bytes"""
FORMAT = 1
ABANDONED = 600
"""s after which nobody writes half a file any more"""
LARGEST = 256 * 2**20
"""bytes that are read of a file, unpacked"""
_CHUNK = 2**20


class Reason(Struct):
    """Something for which a file is written."""

    at: float
    reason: str
    why: str


class Header(Struct):
    """The first line: whose, when and why. `at` is the robot's bus clock, `time` the same moment in UTC."""

    blackbox: int
    robot: str
    version: str
    at: float
    time: str
    reason: str
    why: str
    span: float
    """s from the first message to the last"""
    topics: int
    triggers: list[Reason] = []
    floods: dict[str, list[tuple[int, int]]] = {}
    elsewhere: int = 0


class Recorded(Struct, omit_defaults=True):
    """One message; `wrong` says why nobody on its topic could read it."""

    at: float
    key: str
    encoding: str = ""
    payload: Any = UNSET
    base64: str | UnsetType = UNSET
    proof: Proof | None = None
    attachment: str = ""
    deleted: bool = False
    wrong: str = ""


class Recording(NamedTuple):
    """What could be read of a file, and what could not, in words."""

    header: Header
    lines: list[Recorded]
    trouble: str


def seconds(at: float) -> float:
    """Return a time as a file keeps it."""
    return round(at, 4)


def line_of(raw: Raw, robot: str) -> Recorded:
    """Return what is kept of a message: its values when they are JSON, else its bytes."""
    proof = _proof(raw.attachment)
    line = Recorded(
        at=seconds(raw.at),
        key=raw.path if "*" in raw.path else f"robot/{robot}/{raw.path}",
        encoding=raw.encoding,
        proof=proof,
        attachment="" if proof else _text(raw.attachment),
        deleted=raw.deleted,
        wrong=_fault(raw),
    )
    try:
        line.payload = msgspec.json.decode(raw.payload)
        msgspec.json.encode(line)  # what was read need not be writable one level deeper
    except (msgspec.MsgspecError, RecursionError, ValueError, OverflowError):
        line.payload, line.base64 = UNSET, _text(raw.payload)
    return line


def _proof(attachment: bytes) -> Proof | None:
    """Return a proof that can be read back: JSON knows no NaN, and what never was is told as long ago."""
    found = codec.unpack_proof(attachment)
    if found is None:
        return None
    beat, acted, began = (max(at, LONG_AGO) for at in (found.beat, found.acted, found.began))
    told = found._replace(beat=beat, acted=acted, began=began)
    return told if all(map(isfinite, told)) else None


def write(folder: Path, header: Header, messages: Iterable[Raw]) -> Path:
    """Write a file that is there as a whole or not at all, and remove old ones; raises OSError."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{_stamp(header.time)}-{header.reason}{SUFFIX}"
    new = folder / f".{path.name}.{os.getpid()}"
    _remove(_halves(folder))
    try:
        with new.open("wb") as file:
            with gzip.GzipFile("", "wb", LEVEL, file, mtime=0) as packed:
                packed.write(msgspec.json.encode(header) + b"\n")
                for raw in messages:
                    packed.write(msgspec.json.encode(line_of(raw, header.robot)) + b"\n")
            file.flush()
            os.fsync(file.fileno())
        new.replace(path)
    finally:
        _remove([new])
    _remove(_superfluous(folder, header.reason, path))
    return path


def files(folder: Path) -> list[Path]:
    """Return a folder's files, the oldest first."""
    return in_order(path for path in folder.glob(f"*{SUFFIX}") if not path.name.startswith("."))


def in_order(paths: Iterable[Path]) -> list[Path]:
    """Return files in the order in which they were written."""
    return sorted(paths, key=lambda path: (_age(path), path.name))


def reason_of(path: Path) -> str:
    """Return the reason in a file's name."""
    return path.name.removesuffix(SUFFIX).partition("-")[2]


def read(path: Path) -> Recording:
    """Return what can be read of a file; raises ConfigError where that is nothing."""
    try:
        data, trouble = _unpack(path)
    except OSError as error:
        gone = f"; of each reason the {KEPT} newest are kept" if isinstance(error, FileNotFoundError) else ""
        raise ConfigError(f"cannot read {path}: {error.strerror or error}{gone}") from None
    first, *rest = data.split(b"\n")
    try:
        header = msgspec.json.decode(first, type=Header)
    except (msgspec.MsgspecError, RecursionError, ValueError):
        raise ConfigError(
            f"{path} is no black box of zteleop, or its beginning is damaged; "
            "zteleop blackbox --list shows those of this machine"
        ) from None
    lines = [line for text in rest if text and (line := _parse(text))]
    broken = sum(1 for text in rest if text) - len(lines)
    if broken and not trouble:
        trouble = f"{broken} line{'s'[: broken - 1]} of it cannot be read"
    return Recording(header, lines, trouble)


def _unpack(path: Path) -> tuple[bytes, str]:
    """Return the text of a file as far as it goes, and where it ends too early why."""
    data, packed = bytearray(), zlib.decompressobj(31)
    with path.open("rb") as file:
        plain = file.peek(1)[:1] == b"{"  # somebody has unpacked it
        while chunk := file.read(_CHUNK):
            try:
                data += chunk if plain else packed.decompress(chunk, LARGEST - len(data) + 1)
            except zlib.error:
                return bytes(data), "its bytes are damaged after what is shown"
            if len(data) > LARGEST:
                return bytes(data[:LARGEST]), f"all beyond {LARGEST >> 20} MB is left out"
            if packed.eof:
                return bytes(data), ""
    return bytes(data), "" if plain else "its end is missing"


def _parse(text: bytes) -> Recorded | None:
    try:
        return msgspec.json.decode(text, type=Recorded)
    except (msgspec.MsgspecError, RecursionError, ValueError):
        return None


def _fault(raw: Raw) -> str:
    """Return why no reader of a known topic takes a message."""
    topic = topic_of(raw.path)
    if raw.deleted or "*" in raw.path:
        return "a delete or a wildcard is no message"
    if not topic.types:
        return ""
    try:
        codec.decode(raw.payload, raw.encoding, codec.decoders(topic.types))
    except MessageError as error:
        return printable(str(error))[:200]
    return ""


def _superfluous(folder: Path, reason: str, newest: Path) -> Iterator[Path]:
    """Yield the files of a reason that are too many; on a clock that went back the new one may look old."""
    others = [path for path in files(folder) if reason_of(path) == reason and path != newest]
    yield from others[: max(0, len(others) - KEPT + 1)]


def _halves(folder: Path) -> Iterator[Path]:
    """Yield what was being written when the power went: it counts as none, and would stay for ever."""
    newest = time.time_ns() - ABANDONED * 10**9
    yield from (path for path in folder.glob(f".*{SUFFIX}.*") if _age(path) < newest)


def _remove(paths: Iterable[Path]) -> None:
    for path in paths:
        try:
            path.unlink(missing_ok=True)
        except OSError:
            continue  # it stays, and is tried again the next time


def _age(path: Path) -> int:
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return 0


def _stamp(utc: str) -> str:
    return utc.replace("-", "").replace(":", "").replace(" ", "T")


def utc(seconds_since_1970: float) -> str:
    """Return a time of day as a header has it."""
    return datetime.fromtimestamp(seconds_since_1970, UTC).strftime("%Y-%m-%d %H:%M:%S.%f")[:-3]


def _text(data: bytes) -> str:
    return base64.b64encode(data).decode()
