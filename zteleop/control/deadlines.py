"""How long is too long, in seconds, from an operator to a wheel; `docs/safety.md` shows the same table."""

from typing import Annotated, NamedTuple

from msgspec import Meta, Struct

SILENCE = 0.3
"""of a keyboard, a pad or a page that drives, until neutral"""
PROGRAM_SILENCE = 0.5
"""of a program, which may say a thing once"""
HEARD_LATE = 0.1
"""that a sender may have heard the robot before it is heard itself, without its silence counting sooner"""
LINK_LOSS = 2.0
"""of silence, after which whoever drove begins anew, from neutral"""
STEP_EVERY = 0.02
"""between two steps of the actuator, and two looks of the watchdog at its clock"""
STEADY_EVERY = 0.05
"""the same, of the actuator while its pulses stay as they are, of the watchdog while the chip rests"""
LATE_STEP = 0.2
"""between two steps, after which a process knows that it was stopped itself"""
ACTUATOR_SILENCE = 0.25
"""without a step, until the watchdog kills it"""
ACTUATOR_START, LONGEST_START = 5.0, 60.0
"""until its first step; whatever was too short is doubled for the next, as a slow machine stays slow"""
WATCHDOG_SILENCE = 0.42
"""without its word, until the actuator is at neutral and ends: 0.45 since it froze at the latest"""
GRACE = 0.25
"""that the actuator has to do what its deadlines ask, before the watchdog does it"""
BLIND = 0.25
"""without a look at the chip, until its outputs are cut: it may repeat any pulses"""
DEAF_AFTER = 0.5
"""in which the watchdog has not heard its own robot on the bus, until that rests"""
DOOR_SILENCE = 0.5
"""without its word that zenoh works, until a door is ended and another opened"""
DOOR_START, LONGEST_OPENING = 10.0, 60.0
"""until its first word; what was too short is doubled for the next"""


class Deadlines(Struct, frozen=True, forbid_unknown_fields=True):
    """Those that a robot's own settings may change."""

    max_age: Annotated[float, Meta(gt=0, le=1)] = 0.3
    """of a command, from the robot's beat back to the robot"""
    operator: Annotated[float, Meta(gt=0, le=5)] = 5.0
    """without an act"""
    link_loss: Annotated[float, Meta(gt=0, le=5)] = LINK_LOSS
    """of silence, after which only a new act from neutral drives again"""
    late_step: Annotated[float, Meta(gt=0.05, le=1)] = LATE_STEP
    """between two steps, after which the robot knows it was stopped itself"""
    stand_still: Annotated[float, Meta(gt=0.05, le=2)] = 0.5
    """of `link_loss`, where the whole machine stood still and nobody watched the chip"""


class Deadline(NamedTuple):
    """One line of the table."""

    silence_of: str
    after: str
    then: str


def table(settings: Deadlines) -> list[Deadline]:
    """Return what follows on each silence, in words."""
    return [
        Deadline(
            "keyboard, pad, page",
            f"{SILENCE:g} s",
            "neutral; drives on with the next act when heard again, "
            f"after {settings.link_loss:g} s only once let go",
        ),
        Deadline("a program's `publish()`", f"{PROGRAM_SILENCE:g} s", "neutral until its next command"),
        Deadline(
            "the robot, to whoever drives it",
            f"{HEARD_LATE:g} s more, from the last beat he heard",
            "neutral until he hears it again",
        ),
        Deadline(
            "the operator",
            f"{settings.operator:g} s",
            "neutral; the next act drives. An input may shorten it, nothing lengthens it",
        ),
        Deadline("the watchdog, to the actuator", f"{WATCHDOG_SILENCE:g} s", "neutral and exit"),
        Deadline(
            "the actuator, to the watchdog",
            f"{ACTUATOR_SILENCE:g} s, {ACTUATOR_START:g} s at its start",
            "killed, neutral until read back, started again",
        ),
        Deadline(
            "the door, to the watchdog",
            f"{DOOR_SILENCE:g} s, {DOOR_START:g} s at its start",
            "ended, another opened; neutral meanwhile",
        ),
        Deadline(
            "the robot, to its own watchdog on the bus", f"{DEAF_AFTER:g} s", "neutral until it is heard"
        ),
        Deadline("the chip, to the watchdog", f"{BLIND:g} s", "its outputs are cut, where a wire does that"),
        Deadline(
            "any of them, to itself",
            f"{settings.late_step:g} s between two steps",
            "an interruption: it stood still, and what it was told before is old",
        ),
    ]
