import argparse
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any

import msgspec

from zteleop.bus import codec, presence
from zteleop.bus.escape import printable
from zteleop.bus.names import resolve
from zteleop.bus.session import Ring, Sample, open_session
from zteleop.bus.topics import topic_of
from zteleop.cli import _company, _options
from zteleop.errors import BusError, MessageError

EXAMPLES = (
    "zteleop echo odom",
    "zteleop echo archangel/drive_status --once",
)
DEPTH = 100
TELL_AFTER = 1.0
"""s of silence at the start until it says for whom it waits"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("topic", help="such as archangel/odom, or odom with --robot")
    parser.add_argument("--once", action="store_true", help="print one message and end")
    parser.add_argument("--json", action="store_true", help="one message a line, as JSON")
    parser.add_argument("--timeout", metavar="SECONDS", type=float, help="give up after so long a silence")


def run(arguments: argparse.Namespace) -> None:
    settings = _options.load(arguments)
    robot = _options.robot_of(arguments.topic, settings)
    with open_session(settings.bus, settle=robot is None) as session:
        name = resolve(arguments.topic, robot or _options.find_robot(session, settings))
        about = topic_of(name.path)
        key = f"{name.key}/**" if about.command and "/" not in name.path else name.key
        ring = session.subscribe(key, DEPTH)
        session.declare_token(presence.endpoint_key(name, "sub", "echo", about.types))

        def why_silent() -> str:
            return printable(f"{name}: {_company.why_silent(name, presence.endpoints(session))}")

        for sample in _samples(ring, arguments.timeout, why_silent):
            if _print(sample, arguments.json) and arguments.once:
                return


def _samples(ring: Ring, timeout: float | None, why_silent: Callable[[], str]) -> Iterator[Sample]:
    """Yield what is said; whoever waits for long is told once for whom."""
    patient = timeout is None or timeout > TELL_AFTER
    sample = _wait(ring, TELL_AFTER if patient else timeout)
    if sample is None and patient:
        print(f"zteleop echo: waits for {why_silent()}", file=sys.stderr, flush=True)
        sample = _wait(ring, None if timeout is None else timeout - TELL_AFTER)
    while sample:
        yield sample
        sample = _wait(ring, timeout)
    if timeout is not None:
        raise BusError(f"for {timeout:g} s nothing was said on {why_silent()}")


def _wait(ring: Ring, timeout: float | None) -> Sample | None:
    """Return the next sample; None after a silence, or when the session is closed."""
    if timeout is None:
        with suppress(EOFError):
            return ring.recv()
        return None
    give_up = time.monotonic() + timeout
    while (sample := ring.try_recv()) is None and time.monotonic() <= give_up:  # NaN as well
        time.sleep(0.002)
    return sample


def _print(sample: Sample, as_json: bool) -> bool:
    """Print a message; False when it cannot be read, which is said on stderr."""
    if not sample.is_put:
        return False
    try:
        text = render(sample.payload, sample.encoding, as_json)
    except MessageError as error:
        print(printable(f"{sample.key}: {error}"), file=sys.stderr)
        return False
    print(text, flush=True)
    return True


def render(payload: bytes, encoding: str, as_json: bool) -> str:
    """Return a message as text that is safe to print; raises MessageError when it cannot be read."""
    values = codec.decode_any(payload, encoding)
    try:
        text = msgspec.json.encode(values).decode() if as_json else _yaml(values)
    except RecursionError:  # read as JSON it may be, but YAML is written with a deeper stack
        raise MessageError(f"{len(payload)} bytes of {encoding!r}, nested too deeply to show") from None
    return printable(text, keep="\n")


def _yaml(values: Any) -> str:
    import yaml

    dumper: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
    return yaml.dump(values, Dumper=dumper, sort_keys=False, allow_unicode=True) + "---"
