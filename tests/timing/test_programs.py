"""How long a command lasts that nobody repeats, and how late a handler may make another."""

import re
import signal
import time
from collections.abc import Iterator

import pytest
from rig import NEUTRAL, Process, Rig, every, repeating, until
from verdict import Deadline, excusable

from zteleop.bus import clock
from zteleop.messages import String

SILENCE = 0.5
"""s: a program's"""
MARGIN = 0.07
"""s: a beat's age, and a step of the robot"""
FULL_LEFT = (460, 370)
"""What a turn means to a car that stands."""
START = """
import time
from zteleop import BusSettings, Node, PWMController, Twist
from zteleop.bus import clock
from zteleop.messages import String
node = Node("program", robot="bench", bus=BusSettings(connect=["{endpoint}"], multicast=False))
"""
ONE_TURN = """
with node:
    node.publisher("cmd_vel", Twist).publish(Twist.planar(angular=1.0))
    node.spin()
"""
ONE_PULSE = """
node.close()
PWMController(1).set_pwm(460)
time.sleep(60)
"""
TICKING = """
count = 0
with node:
    @node.every(0.01)
    def tick() -> None:
        global count
        count += 1

    node.spin(2.0)
print("ticked", count)
"""
SLOW = """
with node:
    @node.on("slow", String)
    def slow(note: String) -> None:
        time.sleep(0.1)

    @node.on("fast", String)
    def fast(note: String) -> None:
        print("newest", clock.now() - float(note.data), flush=True)

    print("listening", flush=True)
    node.spin()
"""


@pytest.fixture
def rig(rig: Rig) -> Iterator[Rig]:
    rig.set("blackbox = false")  # it hears whoever publishes: nobody could be awaited by that
    rig.set(f'robot = "{rig.robot}"')
    with open(rig.folder / "config.toml", "a") as config:
        config.write(f'[bus]\nconnect = ["{rig.endpoint}"]\nmulticast = false\n')
    rig.run("actuator", "--listen", rig.endpoint, "--config", robots(rig)).says("obeys")
    return rig


def robots(rig: Rig) -> str:
    """Write the robot's own config file, which connects to nobody."""
    file = rig.folder / "robot.toml"
    text = (rig.folder / "config.toml").read_text()
    file.write_text(text.replace("connect", "listen"))
    return str(file)


@pytest.mark.parametrize("text", [ONE_TURN, ONE_PULSE], ids=["publish", "PWMController"])
def test_what_a_program_says_once_lasts_half_a_second(rig: Rig, text: str) -> None:
    rig.program(START.format(endpoint=rig.endpoint) + text)
    until(lambda: rig.ticks == FULL_LEFT, "the wheels to the left")
    Deadline(rig).met(lambda: rig.ticks == NEUTRAL, "neutral", SILENCE + MARGIN, not_before=SILENCE - MARGIN)


@pytest.mark.parametrize("times", [["--once"], ["-t", "3", "-r", "20"]], ids=["once", "three-times"])
def test_what_pub_says_last_lasts_half_a_second(rig: Rig, times: list[str]) -> None:
    pub = rig.join("pub", "cmd_vel", "Twist", "{linear: {x: 1.0}, angular: {z: 1.0}}", *times)
    pub.says(f"publishing #{times[1] if len(times) > 1 else 1}: Twist(")
    deadline = Deadline(rig)
    until(lambda: rig.ticks != NEUTRAL, "motion")
    deadline.met(lambda: rig.ticks == NEUTRAL, "neutral", SILENCE + MARGIN, not_before=SILENCE - MARGIN)
    assert pub.ends() == 0
    assert pub.text.count("publishing #") == (3 if len(times) > 1 else 1)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_pub_that_is_ended_lets_go_before_its_silence_would(rig: Rig, number: int) -> None:
    pub = rig.join("pub", "cmd_vel", "Twist", "{linear: {x: 1.0}}", "-r", "20")
    until(lambda: rig.ticks[1] > NEUTRAL[1] + 5, "motion")
    deadline = Deadline(rig)
    pub.signal(number)
    deadline.met(lambda: rig.ticks == NEUTRAL, "neutral", 0.1)


def let_stand_still(rig: Rig, seconds: float) -> Process:
    """Drive by `pub`, and let it stand still for a while, as Ctrl-Z and fg do."""
    program = rig.join("pub", "cmd_vel", "Twist", "{linear: {x: 0.3}}", "-r", "10")
    until(lambda: rig.ticks != NEUTRAL, "motion")
    program.signal(signal.SIGSTOP)
    until(lambda: rig.ticks == NEUTRAL, "neutral")
    time.sleep(seconds - SILENCE)
    program.signal(signal.SIGCONT)
    return program


def test_a_pub_that_stood_still_for_a_moment_drives_on(rig: Rig) -> None:
    program = let_stand_still(rig, 1.0)
    with excusable(0.1, rig):
        until(lambda: rig.ticks != NEUTRAL, "motion")
        assert not re.search("refused|comes to|is not heard|is said every", program.text)


def test_a_pub_that_stood_still_for_longer_is_refused_until_it_is_started_anew(rig: Rig) -> None:
    program = let_stand_still(rig, 4.0)
    program.says(
        "is refused by robot bench, as this process stood still (suspended, or in a long handler): it was"
    )
    for _ in every(0.005, 300):
        assert rig.ticks == NEUTRAL
    assert not re.search("comes to|is not heard|is said every", program.text)


def test_a_timer_keeps_its_rate(rig: Rig) -> None:
    with excusable(0.02, rig):
        ticker = rig.program(START.format(endpoint=rig.endpoint) + TICKING)
        assert int(ticker.says("ticked").split()[1]) == pytest.approx(200, rel=0.02)


def test_a_slow_handler_delays_another_topic_by_one_run_at_most(rig: Rig) -> None:
    node = rig.node()
    listener = rig.program(START.format(endpoint=rig.endpoint) + SLOW)
    listener.says("listening")
    slow, fast = node.publisher("slow", String), node.publisher("fast", String)
    until(lambda: slow.matched and fast.matched, "somebody who listens")
    with excusable(0.03, rig):
        with repeating(lambda: slow.publish(String("x")), 0.005):
            for number in range(4):
                fast.publish(String(str(clock.now())))
                until(lambda number=number: len(listener.lines) > number + 1, "the newest")
        delays = [float(line.split()[-1]) for line in listener.lines if line.startswith("newest")]
        assert max(delays) < 0.1 + 0.05, delays
