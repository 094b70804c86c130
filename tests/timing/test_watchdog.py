"""How soon the watchdog ends what its actuator does although it must not."""

from collections.abc import Callable

import pytest
from bench import (
    FORWARD,
    HEARS_NO_STOP,
    IGNORES_IDLENESS,
    IGNORES_SILENCE,
    MOVES_ALTHOUGH_STOPPED,
    STREAM,
    Bench,
    defective,
)
from rig import Rig, hear, repeating
from verdict import Deadline

GRACE = 0.25 + 0.1
"""s that an actuator has beyond its own deadline, and two looks at the chip"""
BEAT = 0.07
"""s: a beat's age, and a step of the robot"""


def neutral(deadline: Deadline, bench: Bench, within: float) -> None:
    deadline.met(lambda: bench.at_rest, "neutral", within)


def wait_idly(bench: Bench) -> None:
    """Hold on without an act."""
    deadline = Deadline(bench.rig)
    with bench.driven(acts=False):
        neutral(deadline, bench, 5.0 + BEAT + GRACE)


def fall_silent(bench: Bench) -> None:
    with bench.driven():
        pass
    neutral(Deadline(bench.rig), bench, 0.3 + BEAT + GRACE)


def press_stop(bench: Bench) -> None:
    with bench.driven():
        deadline = Deadline(bench.rig)
        bench.press_stop()
        neutral(deadline, bench, GRACE)


@pytest.mark.parametrize(
    ("defect", "strike", "by", "why"),
    [
        (IGNORES_IDLENESS, wait_idly, "the watchdog", "although no act on keyboard "),
        (IGNORES_SILENCE, fall_silent, "the watchdog", " has been silent for 0."),
        (HEARS_NO_STOP, press_stop, "the test", "stops the robot: the test"),
    ],
    ids=["ignores its operator's idleness", "ignores silence", "hears no stop"],
)
def test_a_defective_actuator_is_stopped_by_its_watchdog(
    rig: Rig, defect: str, strike: Callable[[Bench], None], by: str, why: str
) -> None:
    bench = defective(rig, defect)
    strike(bench)
    bench.is_latched(by)
    hear(bench.statuses, lambda status: status.state == "stopped", "stopped")
    bench.watchdog.says(why)
    with repeating(lambda: bench.pwm.publish(FORWARD), STREAM):
        bench.stays_neutral()


def test_an_actuator_that_moves_although_it_is_stopped(rig: Rig) -> None:
    bench = defective(rig, MOVES_ALTHOUGH_STOPPED)
    with bench.driven():
        deadline = Deadline(bench.rig)
        bench.press_stop()
        neutral(deadline, bench, GRACE + 0.05)
        bench.is_latched("the test")
        bench.watchdog.says("its pulses moved although a stop is in force; the chip is kept at rest")
        hear(bench.dogs, lambda dog: dog.restarts == 1 and dog.state == "watching", "another actuator")
        bench.stays_neutral()
