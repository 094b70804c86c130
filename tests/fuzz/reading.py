"""What every target shares: the corpus, a folder to write to, and what is safe to print."""

import tempfile
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import zenoh

from zteleop.bus import codec
from zteleop.config import Config
from zteleop.control.drive import Drive
from zteleop.control.report import to_vehicle
from zteleop.messages import MESSAGES

ALL = codec.decoders(MESSAGES.values())
CORPUS = Path(__file__).with_name("corpus")
FOLDERS: list[Any] = []


def corpus(target: str) -> list[Path]:
    """Return the files that are kept for a target."""
    return sorted(path for path in (CORPUS / target).glob("*") if path.is_file())


def parts(data: bytes) -> tuple[str, bytes]:
    """Return the encoding and the payload that a file of the corpus has."""
    encoding, _, payload = data.partition(b"\n")
    return encoding.decode("utf-8", "replace"), payload


def safe(text: str) -> None:
    """Check that no terminal takes a text for more than text."""
    assert text.replace("\n", "").isprintable()
    text.encode()


def use(settings: Config) -> None:
    """Check that settings that were taken can be obeyed."""
    drive = Drive(settings.drive, 4.08, epoch=1, now=0.0)
    assert drive.step(0.02).state == "idle"
    assert codec.encode(to_vehicle(settings.drive, 4.08))
    assert settings.driver_settings(settings.driver, "archangel") is not None


def is_key(text: str) -> bool:
    with suppress(zenoh.ZError):
        return str(zenoh.KeyExpr(text)) == text
    return False


@cache
def scratch() -> Path:
    """Return a folder for the files that targets write; it goes with the process."""
    folder = tempfile.TemporaryDirectory(prefix="zteleop-fuzz-")
    FOLDERS.append(folder)
    return Path(folder.name)
