"""What lies on a robot's disk, and what its processes tell each other."""

import json
import os
import socket
from contextlib import suppress
from mmap import ACCESS_WRITE

import msgspec
from fuzz.reading import ALL, parts, safe, scratch, use

from zteleop import config
from zteleop.bus import codec
from zteleop.bus.escape import printable
from zteleop.bus.names import robot_name
from zteleop.bus.tap import Raw
from zteleop.cli.blackbox import _show
from zteleop.drivers.chip import LEDS, Chip
from zteleop.drivers.chip_file import FILE_SIZE, map_file
from zteleop.drivers.simulated import SimulatedSettings, open_driver
from zteleop.errors import ConfigError, DeviceError
from zteleop.machine import link
from zteleop.machine.child import Child
from zteleop.machine.link import ActuatorEnd, WatchdogEnd
from zteleop.machine.stop_file import StopFile
from zteleop.messages import MESSAGES
from zteleop.processes import actuator
from zteleop.recording import blackbox_file
from zteleop.recording.journal_file import Entry, JournalFile

TIME = codec.encoding_of(MESSAGES["builtin_interfaces/msg/Time"])


def config_text(data: bytes) -> None:
    """Make a robot of a config.toml."""
    try:
        settings = config.parse(data)
    except ConfigError as error:
        safe(printable(str(error), keep="\n"))
        return
    use(settings)


def orders(data: bytes) -> None:
    """Read what a watchdog gives its actuator on standard input."""
    try:
        settings, _ = actuator.orders(data)
    except ConfigError:
        return
    use(settings)


def stop_file(data: bytes) -> None:
    """Start with a stop file that holds anything: the robot is stopped."""
    path = scratch() / "stop"
    path.write_bytes(data)
    stops = StopFile(path, lambda text: None).load()
    assert stops
    for stop in stops:
        assert stop.engaged
        codec.encode(stop)


def link_of_actuator(data: bytes) -> None:
    """Hear a watchdog out, in pieces of the length that the first byte says."""
    ours, theirs = socket.socketpair()
    end, size = ActuatorEnd(theirs), 1 + (data[0] if data else 0)
    with ours, suppress(DeviceError):
        for at in range(1, len(data), size):
            ours.send(data[at : at + size])
            words = end.read()
            assert all(codec.encode(stop) for stop in words.stops)
        assert len(end._rest) < 2**16 + 3
    end.close()


def link_of_watchdog(data: bytes) -> None:
    """Hear an actuator out: whatever it reports, its silence is noticed."""
    ours, theirs = socket.socketpair()
    end, size = WatchdogEnd(theirs), 1 + (data[0] if data else 0)
    child = Child(["none"], b"")
    child.link, child.started = end, 100.0
    with ours:
        for at in range(1, len(data), size):
            ours.send(data[at : at + size])
            child.hear(0.0)
        assert child.silence(101.0) >= 0
        assert child.silence(1e300) > 1
    assert len(end._rest) < link._REPORT.size
    end.close()


def journal(data: bytes) -> None:
    """Keep a journal in a file that holds anything, of words that say anything."""
    path, text = scratch() / "journal.jsonl", data.decode("utf-8", "surrogateescape")
    path.write_bytes(data)
    file = JournalFile(path)
    file.put(Entry(codec.decode(b'{"sec":0,"nanosec":0}', TIME, ALL), 0.0, "act", {"why": text}))  # type: ignore[arg-type]
    file.close()
    assert not file.trouble
    last = path.read_bytes().splitlines()[-1]
    assert json.loads(last)["event"] == "act"
    assert last.decode().isprintable()


def kept(data: bytes) -> None:
    """Keep a message in a black box: whatever it says is one line."""
    encoding, payload = parts(data)
    for path in ("stop", "pwm/keyboard", "lidar"):
        line = blackbox_file.line_of(Raw(1.0, path, encoding, payload, payload[-48:], False), "archangel")
        assert b"\n" not in msgspec.json.encode(line)


def blackbox(data: bytes) -> None:
    """Show a black box whose file holds anything."""
    path = scratch() / "blackbox"
    path.write_bytes(data)
    try:
        recording = blackbox_file.read(path)
    except ConfigError as error:
        safe(printable(str(error)))
        return
    for every, as_json in ((False, False), (True, False), (False, True)):
        for line in _show(recording, every, as_json):
            safe(printable(line))


def chip_file(data: bytes) -> None:
    """Drive a simulated chip whose file holds anything, now and after somebody has changed it."""
    path = scratch() / "chip"
    path.write_bytes(data)
    with map_file(str(path), ACCESS_WRITE) as memory:
        chip = Chip(memory)
        chip.read(0, 1)
        path.write_bytes(data[::-1])  # cut short first, under the mapping
        with suppress(OSError):
            chip.write([(LEDS[0], bytes(4))])
        assert len(memory[:]) == FILE_SIZE
    path.write_bytes(data[:-16] + bytes(16) if len(data) == FILE_SIZE else data)  # without faults
    driver = open_driver(SimulatedSettings(path=str(path)), exclusive=False)
    with suppress(DeviceError):
        driver.start({0: 1500.0, 1: 1500.0})
        assert driver.read([0, 1])[0]
    driver.close()


def robot_file(data: bytes) -> None:
    """Find anything where this machine keeps its robot's name: a name is read or made."""
    folder = scratch()
    os.environ["XDG_STATE_HOME"] = str(folder)
    file = folder / "zteleop" / "robot"
    file.parent.mkdir(exist_ok=True)
    file.write_bytes(data)
    assert robot_name(config.own_name()) == config.own_name()
