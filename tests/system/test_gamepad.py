"""`zteleop gamepad` and `zteleop keys` as processes, in a terminal; the pad is one that a test moves."""

import os
import signal
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from rig import NEUTRAL, Rig, Terminal, until

LB, RB, B, START, FORWARD, TURN = "BTN_TL", "BTN_TR", "BTN_EAST", "BTN_START", "ABS_Y", "ABS_X"
TESTS = Path(__file__).parents[1]
FAKE = """
import os, sys
if "gamepad" in sys.orig_argv and "FAKE_PAD" in os.environ:
    from zteleop.inputs.evdev import pads
    from zteleop.inputs.gamepad_map import FORGET, Moved

    class Pads:
        def __init__(self, which=""):
            self.name = self.trouble = ""
            self._rest = b""

        names = property(lambda self: [self.name] if self.name else [])

        def __enter__(self):
            self._file = os.open(os.environ["FAKE_PAD"], os.O_RDWR | os.O_NONBLOCK)
            return self

        def __exit__(self, *exc):
            os.close(self._file)

        def fileno(self):
            return self._file

        def read(self, now):
            try:
                self._rest += os.read(self._file, 4096)
            except BlockingIOError:
                return []
            *lines, self._rest = self._rest.split(b"\\n")
            return [moved for line in lines for moved in self._moves(*line.decode().split())]

        def _moves(self, name, value=""):
            if name == "plug":
                self.name = value
                return [FORGET, *(Moved(one, 0.0) for one in os.environ["CONTROLS"].split())]
            if name == "unplug":
                self.name = ""
                return [FORGET]
            return [Moved(name, float(value))]

    pads.EvdevPads = Pads

if "sdl" in sys.orig_argv and "FAKE_PAD" in os.environ:
    from zteleop.inputs import sdl_pads

    def moved_by_the_test(real=sdl_pads._sdl):
        from virtual_pad import VirtualPad

        sdl, pad, rest = real(), VirtualPad(), b""
        file = os.open(os.environ["FAKE_PAD"], os.O_RDWR | os.O_NONBLOCK)

        def pump():
            nonlocal rest
            try:
                rest += os.read(file, 4096)
            except BlockingIOError:
                pass
            *lines, rest = rest.split(b"\\n")
            for name, value in (line.decode().split(" ", 1) for line in lines):
                if name == "plug":
                    pad.plug(value)
                elif name == "unplug":
                    pad.unplug()
                else:
                    pad.move(name, float(value))
            sdl.pump()

        return sdl._replace(pump=pump)

    sdl_pads._sdl = moved_by_the_test
"""


class Pad:
    """A pad in somebody's hands."""

    def __init__(self, folder: Path) -> None:
        (folder / "sitecustomize.py").write_text(FAKE)  # which Python imports at each start
        self.path = folder / "pad"
        os.mkfifo(self.path)
        controls = " ".join((LB, RB, B, START, FORWARD, TURN))
        path = f"{folder}:{TESTS}"
        self.environment = {"PYTHONPATH": path, "FAKE_PAD": str(self.path), "CONTROLS": controls}
        self._file = os.open(self.path, os.O_RDWR)

    def move(self, *moves: tuple[str, object]) -> None:
        os.write(self._file, "".join(f"{name} {value}\n" for name, value in moves).encode())

    def close(self) -> None:
        os.close(self._file)


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[Rig]:
    with Rig(tmp_path) as bench:
        bench.actuator()
        yield bench


@pytest.fixture
def pad(tmp_path: Path) -> Iterator[Pad]:
    pad = Pad(tmp_path)
    yield pad
    pad.close()


@pytest.fixture
def screen(rig: Rig, pad: Pad) -> Iterator[Terminal]:
    terminal = rig.terminal("gamepad", *rig.bus_options(), environment=pad.environment)
    terminal.shows("hold drive", "nobody operates", "pad       waiting for a gamepad: plug one in")
    pad.move(("plug", "Pad"))
    terminal.shows("pad       Pad: hold LB to drive, hold RB for full speed, B stops")
    yield terminal
    terminal.type("q")
    assert terminal.ends() == 0
    terminal.is_as_found()


def drives(rig: Rig, pad: Pad) -> None:
    pad.move((LB, 1), (FORWARD, -1.0))
    until(lambda: rig.ticks[1] > NEUTRAL[1] + 5, "throttle")


def test_a_pad_drives_while_its_deadman_is_held_and_no_longer(rig: Rig, pad: Pad, screen: Terminal) -> None:
    pad.move((FORWARD, -1.0), (TURN, -1.0))
    pad.move((FORWARD, 0.0), (TURN, 0.0))
    drives(rig, pad)
    screen.shows("driving, you operate")
    pad.move((TURN, -1.0))
    until(lambda: rig.ticks[0] > NEUTRAL[0] + 20, "to the left")
    pad.move((TURN, 1.0))
    until(lambda: rig.ticks[0] < NEUTRAL[0] - 20, "to the right")
    pad.move((LB, 0))
    until(lambda: rig.ticks == NEUTRAL, "rest")
    screen.shows("idle, nobody operates")


def test_a_pad_that_is_unplugged_lets_go_and_arms_nothing_when_it_comes_back(
    rig: Rig, pad: Pad, screen: Terminal
) -> None:
    drives(rig, pad)
    pad.move(("unplug", ""))
    until(lambda: rig.ticks == NEUTRAL, "rest")
    screen.shows("waiting for a gamepad")
    pad.move(("plug", "Pad"), (LB, 1), (FORWARD, -1.0))
    screen.shows("driving, you operate")  # found at rest, and pressed then: a new act
    pad.move((LB, 0), (FORWARD, 0.0))
    until(lambda: rig.ticks == NEUTRAL, "rest")


def test_a_button_and_a_key_stop_the_robot_and_a_button_that_is_held_ends_the_stop(
    rig: Rig, pad: Pad, screen: Terminal
) -> None:
    for stop in (lambda: pad.move((B, 1), (B, 0)), lambda: screen.type("\x7f")):
        drives(rig, pad)
        stop()
        until(lambda: rig.ticks == NEUTRAL, "rest")
        screen.shows("stopped")
        pad.move((LB, 0), (FORWARD, 0.0))
        pad.move((START, 1))
        screen.shows("idle, nobody operates")
        pad.move((START, 0))


def test_without_a_terminal_a_pad_drives_and_stops_as_well_and_says_so(rig: Rig, pad: Pad) -> None:
    rig.environment.update(pad.environment)
    service = rig.join("gamepad")
    service.says("waiting for a gamepad: plug one in, or switch it on  ->  idle: ")
    pad.move(("plug", "Pad"))
    service.says("Pad: hold LB to drive, hold RB for full speed")
    drives(rig, pad)
    service.says("  ->  driving: gamepad ")
    pad.move((B, 1), (B, 0))
    until(lambda: rig.ticks == NEUTRAL, "rest")
    service.says("  ->  stopped: ")
    pad.move((LB, 0), (FORWARD, 0.0), (START, 1))
    until(lambda: "  ->  idle: " in service.text.rpartition("  ->  stopped: ")[2], "the end of the stop")
    pad.move((START, 0))
    drives(rig, pad)
    service.signal(signal.SIGTERM)
    service.ends()
    until(lambda: rig.ticks == NEUTRAL, "rest")


def test_a_pad_whose_program_is_killed_stops_the_robot(rig: Rig, pad: Pad) -> None:
    terminal = rig.terminal("gamepad", *rig.bus_options(), environment=pad.environment)
    pad.move(("plug", "Pad"))
    terminal.shows("hold LB to drive")
    drives(rig, pad)
    os.kill(terminal.process.pid, signal.SIGKILL)
    until(lambda: rig.ticks == NEUTRAL, "rest")
    terminal.ends()


def test_what_a_pad_has_is_learned_by_asking_and_is_good_for_config_toml(rig: Rig, pad: Pad) -> None:
    rig.environment |= pad.environment
    learn = rig.run("gamepad", "--learn")
    until(lambda: "waiting for a gamepad" in learn.text, "a question")
    answers = {
        "forward": ("ABS_RZ", -1.0),
        "left": ("ABS_Z", -1.0),
        "dead-man": (RB, 1),
        "full speed": (LB, 1),
    }
    pad.move(
        ("plug", "Pad"), ("ABS_Z", 0.3), ("ABS_RZ", -0.3), ("ABS_Z", 0.0), ("ABS_RZ", 0.0), (B, 1), (B, 0)
    )
    for words, (name, way) in answers.items():
        until(lambda words=words: words in learn.lines[-1], f"a question about {words}")
        pad.move((name, way), (name, 0))
    until(lambda: "stops the robot" in learn.lines[-1], "a question about the stop")
    pad.move((RB, 0), (LB, 1), (LB, 0))
    until(lambda: f"that is {LB}, which is turbo already" in learn.text, "a complaint")
    pad.move((B, 1), (B, 0))
    until(lambda: "ends the stop" in learn.lines[-1], "a question about the release")
    pad.move((RB, 1), (RB, 0))
    assert learn.ends() == 0
    text = learn.text[learn.text.index("[gamepad]") :]
    found = tomllib.loads(text)["gamepad"]
    assert found == {
        **{"forward": "-ABS_RZ", "turn": "-ABS_Z", "deadman": RB, "turbo": LB, "stop": B, "release": ""}
    }
    (rig.folder / "config.toml").write_text(text)
    assert rig.result("check").returncode == 0


def test_a_pad_that_sdl_tells_of_drives_as_one_of_linux_does(rig: Rig, pad: Pad) -> None:
    words = ("gamepad", "--input", "sdl", *rig.bus_options())
    terminal = rig.terminal(*words, environment=pad.environment)
    terminal.shows("pad       waiting for a gamepad: plug one in")
    pad.move(("plug", "Test Pad"))
    terminal.shows("pad       Test Pad: hold LB to drive, hold RB for full speed, B stops")
    pad.move(("leftshoulder", 1), ("lefty", -1.0))
    until(lambda: rig.ticks[1] > NEUTRAL[1] + 5, "throttle")
    pad.move(("leftx", -1.0))
    until(lambda: rig.ticks[0] > NEUTRAL[0] + 20, "to the left")
    terminal.shows("driving, you operate")
    pad.move(("b", 1))
    until(lambda: rig.ticks == NEUTRAL, "rest")
    terminal.shows("stopped")
    pad.move(("b", 0), ("leftshoulder", 0), ("lefty", 0), ("leftx", 0), ("start", 1))
    terminal.shows("idle, nobody operates")
    pad.move(("start", 0), ("leftshoulder", 1), ("lefty", -1.0))
    until(lambda: rig.ticks[1] > NEUTRAL[1] + 5, "throttle")
    pad.move(("unplug", ""))
    until(lambda: rig.ticks == NEUTRAL, "rest")
    terminal.shows("waiting for a gamepad")
    terminal.type("\x03")
    assert terminal.ends() == 0
    terminal.is_as_found()


def test_where_no_pad_is_it_says_so(rig: Rig) -> None:
    result = rig.result("gamepad", "--list")
    assert (result.returncode, result.stdout) == (1, "")
    assert result.stderr.startswith("zteleop gamepad: no gamepad is here")


@pytest.mark.parametrize("tells", [True, False])
def test_keys_shows_what_a_terminal_sends_and_how_to_bind_it(rig: Rig, tells: bool) -> None:
    terminal = rig.terminal("keys", tells_releases=tells)
    terminal.shows("tells when a key is let go" if tells else "does not tell when a key is let go")
    terminal.type("\x1bOQ" if not tells else "\x1b[1;1:1Q")
    terminal.shows("f2            press     bound to nothing")
    terminal.type("w" if not tells else "\x1b[119;1:1u")
    terminal.shows("w             press     forward")
    terminal.type("\x03" if not tells else "\x1b[99;5:1u")
    assert terminal.ends() == 0
    assert b'f2 = "stop robot"' in terminal.output
