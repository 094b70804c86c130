import argparse
import sys
import time
from collections.abc import Iterator
from typing import Any

import msgspec

from zteleop.bus import codec
from zteleop.bus.escape import printable
from zteleop.bus.names import resolve
from zteleop.bus.session import Ring, Sample, open_session
from zteleop.bus.topics import topic_of
from zteleop.cli import _options
from zteleop.errors import BusError, MessageError

DEPTH = 100


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
        command = topic_of(name.path).command and "/" not in name.path
        key = f"{name.key}/**" if command else name.key
        for sample in _samples(session.subscribe(key, DEPTH), arguments.timeout, name.key):
            if _print(sample, arguments.json) and arguments.once:
                return


def _samples(ring: Ring, timeout: float | None, key: str) -> Iterator[Sample]:
    while timeout is None:
        try:
            yield ring.recv()
        except EOFError:  # the session is closed
            return
    while True:
        give_up = time.monotonic() + timeout
        while (sample := ring.try_recv()) is None:
            if not time.monotonic() <= give_up:  # NaN as well
                raise BusError(f"nothing was said on {key} for {timeout:g} s; zteleop list shows the topics")
            time.sleep(0.002)
        yield sample


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
