"""A chip that does not answer, forgets, is written by somebody else, or is gone."""

import os
import signal
import time
from collections.abc import Callable

from zteleop.chaos.bench import Bench
from zteleop.chaos.fault import Act, Fault, Operator
from zteleop.chaos.people import press
from zteleop.chaos.processes import actuator, operator, together
from zteleop.drivers import open_driver
from zteleop.drivers.faults import Faults

FOREVER = 2**32 - 1
OUTAGE = 1.0


def once(put: Callable[[Faults], object]) -> Act:
    """Put a fault in, and leave it to the next transfers."""

    def strike(bench: Bench) -> None:
        with bench.faults() as faults:
            put(faults)

    return strike


def for_long(put: Callable[[Faults], object]) -> Act:
    """Let transfers fail for some two seconds, long enough for whatever looks at the chip to meet it."""

    def strike(bench: Bench) -> None:
        with bench.faults() as faults:
            put(faults)
            time.sleep(2 * OUTAGE)
            faults.clear()

    return strike


def outage(put: Callable[[Faults], object]) -> Act:
    """Let every transfer fail for a while; return when the chip is back."""

    def strike(bench: Bench) -> float:
        with bench.faults() as faults:
            put(faults)
            time.sleep(OUTAGE)
            faults.clear()
            return time.monotonic()

    return strike


def write_beside(bench: Bench) -> float:
    """Stop the robot, and then write full throttle to the chip as another program would."""
    press(bench)
    bench.until(lambda: bench.eye.at_rest, 1.0)
    settings = bench.settings
    values = settings.driver_settings(settings.driver, bench.place.robot) | {"path": bench.place.chip}
    stranger = open_driver(settings.driver, values, exclusive=False)
    stranger.write({servo.channel: servo.max_us for servo in settings.drive.servos.values()})
    written = time.monotonic()
    stranger.close()
    return written


def remove_file(bench: Bench) -> None:
    os.unlink(bench.place.chip)


SOON = 0.2
"""s until neutral is on a chip that takes only some of its transfers; at random: one in two fails"""
BAD: dict[str, Callable[[Faults], object]] = {
    "bus fails 1 in 2": lambda faults: faults.every(2),
    "bus fails 1 in 3": lambda faults: faults.every(3),
    "bus fails at random": lambda faults: faults.at_random(50),
    "bus takes 20 ms": lambda faults: faults.slow(20),
    "bus takes 100 ms": lambda faults: faults.slow(100),
}
LONG = {"bus takes 20 ms": 0.1, "bus takes 100 ms": 0.5}
"""s in addition: a transfer is awaited, of the watchdog's look perhaps three, and then comes neutral"""
ENDS: tuple[tuple[str, Act, Operator], ...] = (
    ("operator killed", operator(signal.SIGKILL), "program"),
    ("actuator killed", actuator(signal.SIGKILL), "here"),
    ("stop pressed", press, "here"),
)
FAULTS = (
    Fault("chip does not answer once", once(lambda f: f.nack(1)), None, "drives", simulated=True),
    Fault("chip answers two times of three", for_long(lambda f: f.every(3)), None, "drives", simulated=True),
    Fault("chip answers every second time", for_long(lambda f: f.every(2)), None, "drives", simulated=True),
    *(
        Fault(
            f"{what}, {how}",
            together(once(put), act),
            SOON + LONG.get(how, 0.0),
            operator=who,
            simulated=True,
        )
        for how, put in BAD.items()
        for what, act, who in ENDS
    ),
    Fault("chip back after 1 s", outage(lambda f: f.nack(FOREVER)), 0.2, simulated=True),
    Fault("bus hangs for 1 s", outage(lambda f: f.hang(FOREVER, 20)), 0.3, simulated=True),
    Fault("a write is torn", once(lambda f: f.tear(1, 3)), None, "drives", simulated=True),
    Fault("chip loses its supply", once(lambda f: f.brown_out()), 0.2, simulated=True),
    Fault("another program writes to the chip", write_beside, simulated=True),
    Fault("chip's file is removed", remove_file, 0.3, simulated=True),
    Fault(
        "chip's file gone, actuator frozen",
        together(remove_file, actuator(signal.SIGSTOP)),
        0.4,
        simulated=True,
    ),
)
