"""Processes that die, freeze, fail inside, or hang."""

import os
import signal
import time
from collections.abc import Callable

from zteleop.chaos.bench import Bench
from zteleop.chaos.fault import Act, Fault
from zteleop.chaos.terminal import LEFT

STILL = 3.0
"""s that frozen processes stand still"""


def actuator(number: int) -> Act:
    return lambda bench: os.kill(bench.actuator, number)


def watchdog(number: int) -> Act:
    return lambda bench: bench.watchdog.signal(number)


def door(number: int) -> Act:
    return lambda bench: os.kill(bench.door, number)


def operator(number: int) -> Act:
    def strike(bench: Bench) -> None:
        if bench.operator:
            bench.operator.signal(number)

    return strike


def together(*acts: Act) -> Act:
    """Do several things as nearly at once as can be."""

    def strike(bench: Bench) -> None:
        for act in acts:
            act(bench)

    return strike


def stand_still(bench: Bench) -> float:
    """Freeze both for a while, in which commands pile up; return when they go on."""
    together(actuator(signal.SIGSTOP), watchdog(signal.SIGSTOP))(bench)
    time.sleep(STILL)
    went_on = time.monotonic()
    together(actuator(signal.SIGCONT), watchdog(signal.SIGCONT))(bench)
    return went_on


def order(words: str, whom: Callable[[int], Act]) -> Act:
    """Let a process do to itself what only it can."""

    def strike(bench: Bench) -> None:
        bench.place.order.write_text(words)
        whom(signal.SIGUSR1)(bench)

    return strike


def freeze_keyboard(bench: Bench) -> None:
    if bench.terminal:
        bench.terminal.hands_off = True
    operator(signal.SIGSTOP)(bench)


def thaw_keyboard(seconds: float) -> Act:
    """Return what lets the keyboard go on after a while, in which somebody hammered its keys."""

    def afterwards(bench: Bench) -> None:
        time.sleep(seconds)
        if bench.terminal:
            bench.terminal.type(5 * LEFT)
        operator(signal.SIGCONT)(bench)

    return afterwards


def hang_up(bench: Bench) -> None:
    """Close the operator's terminal, as when its window is closed."""
    if bench.terminal:
        bench.terminal.close()


FAULTS = (
    Fault("actuator killed", actuator(signal.SIGKILL)),
    Fault("actuator crashes", actuator(signal.SIGSEGV)),
    Fault("actuator frozen", actuator(signal.SIGSTOP), 0.4, then="either"),
    Fault("actuator told to end", actuator(signal.SIGTERM)),
    Fault("actuator hangs at its end", together(order("hang", actuator), actuator(signal.SIGTERM))),
    Fault("actuator: an error in its loop", order("raise MainThread", actuator)),
    Fault("watchdog killed", watchdog(signal.SIGKILL)),
    Fault("watchdog crashes", watchdog(signal.SIGSEGV)),
    Fault("watchdog frozen", watchdog(signal.SIGSTOP), 0.45),
    Fault("watchdog told to end", watchdog(signal.SIGTERM)),
    Fault("watchdog: an error in its loop", order("raise MainThread", watchdog)),
    Fault("door killed", door(signal.SIGKILL), None, then="drives"),
    Fault("door frozen", door(signal.SIGSTOP), 0.35, then="drives"),
    Fault("door: an error in its loop", order("raise MainThread", door), None, then="drives"),
    Fault("both stood still for 3 s", stand_still),
    Fault("operator killed", operator(signal.SIGKILL), operator="program"),
    Fault("operator frozen", operator(signal.SIGSTOP), 0.35, operator="program"),
    Fault("operator told to end", operator(signal.SIGTERM), operator="program"),
    Fault("keyboard killed", operator(signal.SIGKILL), operator="keyboard"),
    Fault("keyboard frozen", operator(signal.SIGSTOP), 0.35, operator="keyboard"),
    Fault(
        "keyboard back after 0.6 s", freeze_keyboard, 0.35, operator="keyboard", afterwards=thaw_keyboard(0.3)
    ),
    Fault(
        "keyboard back after 3 s", freeze_keyboard, 0.35, operator="keyboard", afterwards=thaw_keyboard(2.7)
    ),
    Fault("keyboard's terminal closed", hang_up, operator="keyboard"),
    Fault(
        "operator and actuator killed",
        together(operator(signal.SIGKILL), actuator(signal.SIGKILL)),
        operator="program",
    ),
    Fault(
        "operator frozen, watchdog killed",
        together(operator(signal.SIGSTOP), watchdog(signal.SIGKILL)),
        operator="program",
    ),
)
