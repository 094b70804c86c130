"""What an operator types: keys, words after a verb, texts."""

import argparse
import json
from contextlib import redirect_stderr, suppress
from importlib import import_module
from io import StringIO

from fuzz.reading import ALL, safe

from zteleop.bus import codec
from zteleop.bus.escape import printable
from zteleop.cli import VERBS, file_of
from zteleop.config import Config
from zteleop.control.report import to_vehicle
from zteleop.errors import ConfigError, MessageError
from zteleop.inputs.keyboard import ACTIONS, Keyboard
from zteleop.inputs.keymap import DIRECTIONS, bindings
from zteleop.interfaces.values import fill
from zteleop.messages import MESSAGES
from zteleop.terminal.keys import Key, KeyParser, Report
from zteleop.testing import FakeTerminal
from zteleop.text import yaml_text

DRIVE_ACTIONS = {*ACTIONS, *DIRECTIONS}


def keys(data: bytes) -> None:
    """Take a terminal's bytes for keys."""
    parser = KeyParser()
    found = [key for byte in data for key in (*parser.flush(byte / 99), *parser.feed(bytes((byte,)), 0.0))]
    assert all(isinstance(one, Report) or one.name for one in found)
    assert found.count(Key("ctrl-c")) >= data.count(b"\x03")
    parser.feed(b"\x03")
    assert parser.feed(b"q") == [Key("q")]


def keyboard(data: bytes) -> None:
    """Drive with a terminal's bytes, in pieces, on either way to drive."""
    for drive in ("step", "hold"):
        terminal, now = FakeTerminal(), 100.0
        device = Keyboard(drive, terminal=terminal)  # type: ignore[arg-type]
        device.fit(to_vehicle(Config().drive, 4.08))
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
            found = bindings(wanted)
        except ConfigError as error:
            safe(printable(str(error)))
            return
        assert set(found.values()) <= DRIVE_ACTIONS
        device = Keyboard(keys=wanted, terminal=FakeTerminal())  # type: ignore[arg-type]
        for key in found:
            device._press(Key(key))


def values(data: bytes) -> None:
    """Take any text for the YAML that somebody publishes."""
    text = data.decode("utf-8", "surrogateescape")
    try:
        said = yaml_text.load(text)
    except MessageError as error:
        safe(printable(str(error)))
        return
    for kind in MESSAGES.values():
        with suppress(MessageError):
            found = fill(kind, said)
            assert codec.decode(codec.encode(found), codec.encoding_of(kind), ALL) == found


def arguments(data: bytes) -> None:
    """Type any words after a verb: options, or usage and exit code 2."""
    verb, *words = data.decode("utf-8", "surrogateescape").split("\n")
    parser = argparse.ArgumentParser(prog="zteleop")
    module = import_module(f"zteleop.cli.{file_of(verb if verb in VERBS else 'actuator')}")
    module.add_arguments(parser)
    with redirect_stderr(StringIO()), suppress(SystemExit):
        parser.parse_args([word for word in words if word not in ("-h", "--help")])
