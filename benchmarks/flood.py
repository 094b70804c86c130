"""Does a flood of commands reach the operator's wheel, or the actuator's memory?"""

import subprocess
import sys
import time

from figures import is_quick, median, p99, print_table, verdict
from idle_cost import cpu_seconds, private_mb
from robot import RAW_LINE, Operator, Robot

FLOODS = {
    "unknown source": ("cmd_vel/stranger", "none"),
    "known source, no proof": ("cmd_vel/program", "none"),
    "known source, stale proof": ("cmd_vel/program", "stale"),
}
MEMORY_TARGET, RATIO_TARGET = 10.0, 1.5
SETTLE = 1.0


class Flooded:
    """What the operator and the actuator felt, summed over rounds."""

    def __init__(self) -> None:
        self.samples: list[float] = []
        self.rates: list[float] = []
        self.cpu: list[float] = []
        self.grown = 0.0
        self.missed = 0


def measure(robot: Robot, operator: Operator, found: Flooded, seconds: float) -> None:
    """Steer for some seconds."""
    memory, cpu, missed = private_mb(robot.actuator), cpu_seconds(robot.actuator), operator.missed
    began = now()
    while now() - began < seconds:
        found.samples += operator.steer(6)
        found.grown = max(found.grown, private_mb(robot.actuator) - memory)
    found.cpu.append(100 * (cpu_seconds(robot.actuator) - cpu) / (now() - began))
    found.missed += operator.missed - missed


def measure_flood(
    robot: Robot, operator: Operator, found: Flooded, how: tuple[str, str], seconds: float
) -> None:
    """Steer while a process of its own says commands as fast as it is told to."""
    arguments = [robot.endpoint, *how, str(seconds + 2 * SETTLE)]
    process = robot.start_program([sys.executable, RAW_LINE, "flood", *arguments], stdout=subprocess.PIPE)
    assert process.stdout
    process.stdout.readline()
    time.sleep(SETTLE)
    measure(robot, operator, found, seconds)
    found.rates.append(float(process.stdout.readline()))
    process.wait()


def now() -> float:
    return time.monotonic()


def main() -> None:
    quick = is_quick(__doc__)
    rounds, seconds = (1, 1.0) if quick else (2, 12.0)
    found = {name: Flooded() for name in ("alone", *FLOODS)}
    with Robot() as robot:
        operator = Operator(robot)
        for _ in operator.steer(10):
            pass
        for _ in range(rounds):
            measure(robot, operator, found["alone"], seconds)
            for name, how in FLOODS.items():
                measure_flood(robot, operator, found[name], how, seconds)
                time.sleep(SETTLE)
    alone = median(found["alone"].samples)
    rows = []
    for name, flooded in found.items():
        rate, ratio = (median(flooded.rates) if flooded.rates else 0.0), median(flooded.samples) / alone
        targets = f"{verdict(flooded.grown, MEMORY_TARGET, 'MB')}; {verdict(ratio, RATIO_TARGET, 'x')}"
        latency = (median(flooded.samples), p99(flooded.samples), ratio, flooded.missed)
        rows.append((name, f"{rate:.0f}", *latency, flooded.grown, median(flooded.cpu), targets))
    head = ["flood", "said/s", "p50 ms", "p99 ms", "of alone", "missed", "MB grown", "CPU %", "target"]
    print_table(f"key to wheel during floods, {rounds} x {seconds:g} s each, in turn", head, rows)


if __name__ == "__main__":
    main()
