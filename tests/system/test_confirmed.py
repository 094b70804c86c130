"""A stop is one only where the chip shows it; otherwise whoever pressed is told to cut the power."""

from collections.abc import Iterator

import pytest
from bench import FORWARD, STREAM
from rig import NEUTRAL, Rig, hear, repeating, until

from zteleop.drivers.faults import Faults
from zteleop.messages import DriveStatus

FOREVER = 2**32 - 1
DELETE = "\x7f"
HEARD = "bench heard the stop, not confirmed by the chip: cut its power"


@pytest.fixture
def faults(rig: Rig) -> Iterator[Faults]:
    """A bus whose chip puts out motion for ever, as soon as a test says so."""
    rig.actuator()
    with Faults(rig.chip) as faults:
        yield faults


def turns_deaf_while_it_drives(rig: Rig, faults: Faults) -> tuple[int | None, int | None]:
    """Let the bus fail for good while somebody drives, and return the pulses that stay."""
    node = rig.node("driver")
    rig.hear(node)
    motors = node.publisher("pwm", type(FORWARD), source="keyboard")
    with repeating(lambda: motors.publish(FORWARD), STREAM):
        until(lambda: rig.ticks != NEUTRAL, "pulses that move")
        faults.nack(FOREVER)
    return rig.ticks


def test_a_stop_of_a_robot_whose_chip_does_not_answer_fails_and_says_what_to_do(
    rig: Rig, faults: Faults
) -> None:
    statuses = rig.node("looker").subscription("drive_status", DriveStatus)
    stays = turns_deaf_while_it_drives(rig, faults)
    done = rig.result("stop", *rig.bus_options())
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith(f"zteleop stop: {HEARD} (nobody answers at 0x40"), done.stderr
    assert rig.ticks == stays != NEUTRAL
    shown = hear(statuses, lambda status: bool(status.stops), "the stop")
    assert (shown.state, shown.confirmed) == ("fault", "")
    why = rig.result("why", *rig.bus_options()).stdout
    assert "not confirmed by the chip: cut its power" in why
    assert "nothing since" in why


def test_the_keyboard_says_so_as_well_and_takes_it_back_when_the_chip_answers(
    rig: Rig, faults: Faults
) -> None:
    keyboard = rig.keyboard(columns=140)
    keyboard.shows(" idle")
    turns_deaf_while_it_drives(rig, faults)
    keyboard.type(DELETE)
    keyboard.shows("● fault", HEARD)
    faults.clear()
    keyboard.shows("● stopped", "bench is stopped (neutral read back from the chip, late)")
    assert rig.ticks == NEUTRAL
