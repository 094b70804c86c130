import argparse
import sys
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import msgspec

from zteleop import config
from zteleop.bus.escape import printable
from zteleop.bus.names import robot_name
from zteleop.cli._scratch import DEMO
from zteleop.errors import ConfigError, nearest
from zteleop.recording import blackbox_file
from zteleop.recording.amounts import SECOND, span
from zteleop.recording.blackbox_file import Header, Recorded, Recording
from zteleop.recording.timeline import Event, timeline
from zteleop.recording.triggers import STOP

EXAMPLES = (
    "zteleop blackbox",
    "zteleop blackbox archangel --list",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("what", metavar="ROBOT|FILE", nargs="?", help="a robot of this machine, or any file")
    parser.add_argument("--robot", metavar="NAME", help="the robot, where a file has the same name")
    kept = f"list the files there are: the {blackbox_file.KEPT} newest of each reason; copy what is to stay"
    parser.add_argument("--list", action="store_true", help=kept)
    parser.add_argument("--all", action="store_true", help="every message a line")
    parser.add_argument("--json", action="store_true", help="the timeline as JSON lines")


def run(arguments: argparse.Namespace) -> None:
    what, robot = arguments.what, arguments.robot
    if what and not robot and not Path(what).is_file() and not _looks_like_a_path(what):
        what, robot = None, what
    if arguments.list:
        for line in _listing(robot):
            print(printable(line))
        if sys.stdout.isatty():
            print(f"(of each reason the {blackbox_file.KEPT} newest are kept; copy what is to stay)")
        return
    path = Path(what) if what else _newest(robot)
    recording = blackbox_file.read(path)
    for line in _show(recording, arguments.all, arguments.json):
        print(printable(line))
    if recording.trouble:
        words = f"not all of this file can be shown: {recording.trouble}"
        print(words, file=sys.stderr if arguments.json else sys.stdout)
    if not what and not arguments.json:
        print(f"({printable(str(path))})")
        more = "the next comes 1 to 10 s late, and none from a robot that lost its power"
        print(f"({_age(recording.header)} old; {more})")
        if stop := _last_stop(path):
            print(f"(the last stop: zteleop blackbox {printable(str(stop))})")


def _age(header: Header) -> str:
    """Return how long ago it was written: it may tell of another time than the reader thinks."""
    written = datetime.fromisoformat(header.time).replace(tzinfo=UTC)
    seconds = max((datetime.now(UTC) - written) // timedelta(seconds=1), 0)
    return f"{seconds} s" if seconds < 60 else span(seconds * SECOND)


def _looks_like_a_path(text: str) -> bool:
    return "/" in text or text.endswith((".gz", ".jsonl"))


def _files(robot: str | None) -> list[Path]:
    """Return the files of a robot, or of all robots of this machine, the oldest first."""
    home = config.state_folder(robot_name(robot) if robot else "any").parent
    demos = Path(tempfile.gettempdir()).glob(f"{DEMO}*/{home.parent.name}/{home.name}")
    folders = [folder for place in (home, *demos) for folder in place.glob(f"{robot or '*'}/blackbox")]
    return blackbox_file.in_order(path for folder in folders for path in blackbox_file.files(folder))


def _newest(robot: str | None) -> Path:
    found = _files(robot)
    if not found:
        near = _near(robot)
        raise ConfigError(
            f"{robot or 'no robot of this machine'} has {'no' if robot else 'a'} black box to show yet: "
            "one is written when a robot is stopped, loses its operator or fails; zteleop blackbox FILE "
            f"shows one from elsewhere{near}"
        )
    return found[-1]


def _last_stop(shown: Path) -> Path | None:
    """Return the file of the robot's last stop, where the one that is shown is of something later."""
    files = blackbox_file.in_order(blackbox_file.files(shown.parent))
    stops = [path for path in files if blackbox_file.reason_of(path) == STOP]
    return stops[-1] if stops and stops[-1] != shown else None


def _near(robot: str | None) -> str:
    """Return which robots of this machine have a black box, where the one that is meant has none."""
    others = {path.parent.parent.name for path in _files(None)}
    return f"; {nearest(robot, others)}" if robot and others else ""


def _listing(robot: str | None) -> Iterator[str]:
    _newest(robot)
    for path in _files(robot):
        owner = path.parent.parent.name
        with suppress(FileNotFoundError):  # a newer one has taken its place meanwhile
            size = f"{path.stat().st_size / 1000:.1f} kB"
            yield f"{_when(path)}  {blackbox_file.reason_of(path):14}  {owner}  {size}  {path}"


def _when(path: Path) -> str:
    """Return the time in a file's name, as a person writes it."""
    text = path.name.partition("-")[0]
    return f"{text[:4]}-{text[4:6]}-{text[6:8]} {text[9:11]}:{text[11:13]}:{text[13:15]} UTC"


def _show(recording: Recording, every: bool, as_json: bool) -> Iterator[str]:
    header = recording.header
    events = timeline(header, recording.lines)
    if as_json:
        yield from (_encode(_values(header, event)) for event in events)
        return
    yield _title(header)
    if every:
        yield from (_message(header, line) for line in recording.lines)
    else:
        yield from (_line(header, event) for event in events)


def _title(header: Header) -> str:
    when = header.time.partition(".")[0]
    reason = header.reason.replace("-", " ")
    return f"black box of {header.robot}: {reason}, {when} UTC, {header.span:.0f} s of {header.topics} topics"


def _line(header: Header, event: Event) -> str:
    mark = "   <- written because of this" if event.reason else ""
    return f"{_relative(header, event.at, event.reason)}  {event.text}{mark}"


def _relative(header: Header, at: float, exact: bool = False) -> str:
    return f"  {'0.00' if exact else f'{at - header.at:+.2f}':>7} s"


def _message(header: Header, line: Recorded) -> str:
    said = "deleted" if line.deleted else line.base64 or _encode(line.payload)
    proof = f"  proof {_encode(line.proof._asdict())}" if line.proof else ""
    return f"{_relative(header, line.at)}  {line.key}  {line.encoding}  {said}{proof}"


def _values(header: Header, event: Event) -> dict[str, Any]:
    at = round(event.at - header.at, 3)
    return {"at": at, "text": event.text, "count": event.count, "reason": event.reason}


def _encode(value: Any) -> str:
    return "" if value is msgspec.UNSET else msgspec.json.encode(value).decode()
