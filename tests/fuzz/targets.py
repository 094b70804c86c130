"""Everything of zteleop that takes bytes which a stranger, or a broken disk, may have written.

Each target takes any bytes at all: it returns, having checked what must hold, or it has found a fault.
"""

import argparse
import json
import os
import socket
import tempfile
from collections.abc import Callable
from contextlib import redirect_stderr, suppress
from functools import cache
from importlib import import_module
from io import StringIO
from mmap import ACCESS_WRITE
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import zenoh

from zteleop import config
from zteleop.bus import codec, presence
from zteleop.bus.escape import printable
from zteleop.bus.names import chunk, resolve, robot_name
from zteleop.bus.session import BusSettings, _check_threads, _configure
from zteleop.cli import VERBS, obey
from zteleop.cli.echo import render as echo
from zteleop.cli.pub import _yaml
from zteleop.config import Config
from zteleop.control.drive import Drive
from zteleop.control.gate import Deadlines, Gate
from zteleop.control.report import describe
from zteleop.drivers.chip import LEDS, Chip
from zteleop.drivers.chip_file import FILE_SIZE, map_file
from zteleop.drivers.simulated import SimulatedSettings, open_driver
from zteleop.errors import ConfigError, DeviceError, MessageError
from zteleop.inputs.cells import printable as shown
from zteleop.inputs.keyboard import ACTIONS, Keyboard
from zteleop.inputs.keymap import DIRECTIONS, bindings
from zteleop.inputs.keys import KeyParser
from zteleop.interfaces.values import fill
from zteleop.messages import MESSAGES, Message
from zteleop.nodes.child import Child
from zteleop.nodes.journal_file import JournalFile, Line
from zteleop.nodes.link import ActuatorEnd, WatchdogEnd
from zteleop.nodes.stop_file import StopFile

ALL = codec.decoders(MESSAGES.values())
CORPUS = Path(__file__).with_name("corpus")
EPOCH = 7 << 50
DRIVE_ACTIONS = {*ACTIONS, *DIRECTIONS}


def corpus(target: str) -> list[Path]:
    """Return the files that are kept for a target."""
    return sorted(path for path in (CORPUS / target).glob("*") if path.is_file())


def message(data: bytes) -> None:
    """Read a message, its encoding in the first line, as a node does and as a person who looks at it."""
    encoding, payload = parts(data)
    found = None
    with suppress(MessageError):
        found = codec.decode(payload, encoding, ALL)
        assert isinstance(found, Message)
    assert found is None or codec.decode(codec.encode(found), encoding, ALL) == found
    for as_json in (False, True):
        with suppress(MessageError):
            safe(echo(payload, encoding, as_json))


def parts(data: bytes) -> tuple[str, bytes]:
    """Return the encoding and the payload that a file of the corpus has."""
    encoding, _, payload = data.partition(b"\n")
    return encoding.decode("utf-8", "replace"), payload


def safe(text: str) -> None:
    """Check that no terminal takes a text for more than text."""
    assert text.replace("\n", "").isprintable()
    text.encode()


def proof(data: bytes) -> None:
    """Judge what attachments prove, the length of each before it."""
    gate, now = Gate(Deadlines(), EPOCH, 100.0), 100.0
    while data:
        length, data = data[0], data[1:]
        attachment, data, now = data[:length], data[length:], now + 0.05
        found = codec.unpack_proof(attachment)
        assert (found is None) == (len(attachment) != 48)
        for moving in (True, False):
            refusal = gate.judge(found, moving, now)
            assert refusal or (found and found.epoch == EPOCH and 0 <= now - found.beat <= 0.3)
            assert refusal or not moving or (found and 100 < found.began <= found.acted <= now)


def config_text(data: bytes) -> None:
    """Make a robot of a config.toml."""
    try:
        settings = config.parse(data)
    except ConfigError as error:
        safe(printable(str(error), keep="\n"))
        return
    use(settings)


def use(settings: Config) -> None:
    """Check that settings that were taken can be obeyed."""
    drive = Drive(settings.drive, 4.08, epoch=1, now=0.0)
    assert drive.step(0.02).state == "idle"
    assert codec.encode(describe(settings.drive, 4.08))
    assert settings.driver_settings(settings.driver, "archangel") is not None


def orders(data: bytes) -> None:
    """Read what a watchdog gives its actuator on standard input."""
    try:
        settings = obey.orders(data)
    except ConfigError:
        return
    use(settings)


def keys(data: bytes) -> None:
    """Take a terminal's bytes for keys."""
    parser = KeyParser()
    found = [key for byte in data for key in (*parser.flush(byte / 99), *parser.feed(bytes((byte,)), 0.0))]
    assert all(isinstance(key, str) and key for key in found)
    assert found.count("ctrl-c") >= data.count(b"\x03")
    parser.feed(b"\x03")
    assert parser.feed(b"q") == ["q"]


class Terminal:
    """A terminal on which somebody types what the fuzzer says."""

    resumed = 0

    def __init__(self) -> None:
        self.typed = b""

    def read(self) -> bytes:
        typed, self.typed = self.typed, b""
        return typed

    def redraw(self) -> None:
        pass

    def suspend(self) -> None:
        self.resumed += 1


def keyboard(data: bytes) -> None:
    """Drive with a terminal's bytes, in pieces, on either way to drive."""
    for drive in ("step", "hold"):
        terminal, now = Terminal(), 100.0
        device = Keyboard(drive, terminal=terminal)  # type: ignore[arg-type]
        device.fit(describe(Config().drive, 4.08))
        for at in range(0, len(data), 7):
            terminal.typed, now = data[at : at + 7], now + 0.03
            device.read(now)
            stick = device.stick(now)
            assert -1 <= stick.forward <= 1
            assert -1 <= stick.turn <= 1
            assert stick.deadman or (stick.forward, stick.turn) == (0.0, 0.0)
            if device.suspending:
                device.suspend(now)
        assert device.stick(now + 6).deadman is False


def keymap(data: bytes) -> None:
    """Bind keys as a JSON object says."""
    with suppress(ValueError, RecursionError):
        said = json.loads(data)
        pairs = said.items() if isinstance(said, dict) else ()
        wanted = {str(key): str(action) for key, action in pairs}
        try:
            found = bindings(wanted, DRIVE_ACTIONS)
        except ConfigError as error:
            safe(printable(str(error)))
            return
        assert set(found.values()) <= DRIVE_ACTIONS
        device = Keyboard(keys=wanted, terminal=Terminal())  # type: ignore[arg-type]
        for key in found:
            device._press(key)


def stop_file(data: bytes) -> None:
    """Start with a stop file that holds anything: the robot is stopped."""
    path = scratch() / "stop"
    path.write_bytes(data)
    stop = StopFile(path, lambda text: None).load()
    assert stop is not None
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
            assert words.stop is None or codec.encode(words.stop)
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
            child.hear()
        assert child.silence(101.0) >= 0
        assert child.silence(1e300) > 1
    assert len(end._rest) < 24
    end.close()


def journal(data: bytes) -> None:
    """Keep a journal in a file that holds anything, of words that say anything."""
    path, text = scratch() / "journal.jsonl", data.decode("utf-8", "surrogateescape")
    path.write_bytes(data)
    file = JournalFile(path)
    file.put(Line(codec.decode(b'{"sec":0,"nanosec":0}', TIME, ALL), 0.0, "act", {"why": text}))  # type: ignore[arg-type]
    file.close()
    assert not file.trouble
    last = path.read_bytes().splitlines()[-1]
    assert json.loads(last)["event"] == "act"
    assert last.decode().isprintable()


TIME = codec.encoding_of(MESSAGES["builtin_interfaces/msg/Time"])


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


def names(data: bytes) -> None:
    """Take any text for the name of a robot, of a topic or of a source."""
    text = data.decode("utf-8", "surrogateescape")
    for read in (robot_name, lambda name: chunk(name, "a node's name"), *resolvers()):
        try:
            found = read(text)
        except ConfigError as error:
            safe(printable(str(error)))
            continue
        key = getattr(found, "key", None) or f"robot/{found}"
        assert str(zenoh.KeyExpr(key)) == key
        assert not {*"*$#?"} & {*key}


def resolvers() -> list[Callable[[str], Any]]:
    return [lambda text: resolve(text, None), lambda text: resolve(text, "archangel")]


def token(data: bytes) -> None:
    """Read keys of liveliness tokens, a line each, as a listing and as an actuator do."""
    found = data.decode("utf-8", "replace").split("\n")
    session: Any = Tokens([f"robot/{key}" for key in found if is_key(f"robot/{key}")])
    departures = presence.Departures(session, "archangel")
    for name in (*presence.robots(session), *presence.holders(session, "archangel", "actuator")):
        safe(name)
    for endpoint in presence.endpoints(session):
        safe("".join(endpoint))
    for name in presence.robots(session):
        assert robot_name(name)
    for key in session.keys:
        gone: Any = SimpleNamespace(key_expr=key, kind=zenoh.SampleKind.DELETE)
        sender = departures.read(gone)
        assert sender is None or 0 <= sender < 2**64


def is_key(text: str) -> bool:
    with suppress(zenoh.ZError):
        return str(zenoh.KeyExpr(text)) == text
    return False


class Tokens:
    """A session that has heard of these tokens."""

    def __init__(self, keys: list[str]) -> None:
        self.keys = keys

    def liveliness(self) -> "Tokens":
        return self

    def declare_subscriber(self, *_: object) -> None:
        return None

    def get(self, selector: str, timeout: float) -> list[Any]:
        wanted = zenoh.KeyExpr(selector)
        return [
            SimpleNamespace(ok=SimpleNamespace(key_expr=key))
            for key in self.keys
            if wanted.intersects(zenoh.KeyExpr(key))
        ]


def endpoint(data: bytes) -> None:
    """Take any text for an address on the bus, and for zenoh's threads."""
    text = data.decode("utf-8", "replace")
    for settings in (BusSettings(connect=[text]), BusSettings(listen=[text])):
        with suppress(ConfigError):
            _configure(settings, settle=False)
    with suppress(ConfigError):
        _check_threads(text)


def values(data: bytes) -> None:
    """Take any text for the YAML that somebody publishes."""
    text = data.decode("utf-8", "surrogateescape")
    try:
        said = _yaml(text)
    except MessageError as error:
        safe(printable(str(error)))
        return
    for kind in MESSAGES.values():
        with suppress(MessageError):
            found = fill(kind, said)
            assert codec.decode(codec.encode(found), codec.encoding_of(kind), ALL) == found


def screen(data: bytes) -> None:
    """Show any text on the keyboard's screen."""
    text = data.decode("utf-8", "replace")
    safe(shown(text))
    assert shown(text, unicode=False).isascii()


def arguments(data: bytes) -> None:
    """Type any words after a verb: options, or usage and exit code 2."""
    verb, *words = data.decode("utf-8", "surrogateescape").split("\n")
    parser = argparse.ArgumentParser(prog="zteleop")
    module = import_module(f"zteleop.cli.{verb if verb in VERBS else 'actuator'}")
    module.add_arguments(parser)
    with redirect_stderr(StringIO()), suppress(SystemExit):
        parser.parse_args([word for word in words if word not in ("-h", "--help")])


def robot_file(data: bytes) -> None:
    """Find anything where this machine keeps its robot's name: a name is read or made."""
    folder = scratch()
    os.environ["XDG_STATE_HOME"] = str(folder)
    file = folder / "zteleop" / "robot"
    file.parent.mkdir(exist_ok=True)
    file.write_bytes(data)
    assert robot_name(config.own_name()) == config.own_name()


@cache
def scratch() -> Path:
    """Return a folder for the files that targets write; it goes with the process."""
    folder = tempfile.TemporaryDirectory(prefix="zteleop-fuzz-")
    FOLDERS.append(folder)
    return Path(folder.name)


FOLDERS: list[Any] = []

TARGETS: dict[str, Callable[[bytes], None]] = {
    "arguments": arguments,
    "chip": chip_file,
    "config": config_text,
    "endpoint": endpoint,
    "journal": journal,
    "keyboard": keyboard,
    "keymap": keymap,
    "keys": keys,
    "link-actuator": link_of_actuator,
    "link-watchdog": link_of_watchdog,
    "message": message,
    "names": names,
    "orders": orders,
    "proof": proof,
    "robot-file": robot_file,
    "screen": screen,
    "stop-file": stop_file,
    "token": token,
    "values": values,
}
