"""From a key byte in a terminal to the registers of the chip, two processes apart, seen from outside."""

import sys

from figures import is_quick, median, p99, print_table, verdict
from robot import RAW_LINE, Operator, RawRobot, Robot

TARGET = 1.5
AT_ONCE = 20


def time_lines(rounds: int) -> tuple[list[float], list[float]]:
    """Return the milliseconds of each press through zteleop and through raw zenoh, taken in turn."""
    ours: list[float] = []
    raw: list[float] = []
    with Robot() as robot, RawRobot() as raw_robot:
        operator = Operator(robot)
        raw_operator = Operator(raw_robot, [sys.executable, RAW_LINE, "key", raw_robot.endpoint])
        for _ in range(rounds):
            ours += operator.steer(AT_ONCE)
            raw += raw_operator.steer(AT_ONCE)
        if operator.missed:
            print(f"{operator.missed} presses moved nothing")
    return ours, raw


def main() -> None:
    quick = is_quick(__doc__)
    ours, raw = time_lines(1 if quick else 15)
    print_table(
        f"key to wheel, ms, {len(ours)} presses",
        ["line", "p50", "p90", "p99", "of raw", "target for p50"],
        [
            _row("zteleop keyboard -> zteleop actuator", ours, raw, verdict(median(ours), TARGET, "ms")),
            _row("peer: terminal -> raw zenoh -> registers", raw, raw, ""),
        ],
    )


def _row(name: str, samples: list[float], raw: list[float], target: str) -> tuple[object, ...]:
    p90 = sorted(samples)[int(0.9 * len(samples))]
    return name, median(samples), p90, p99(samples), f"{median(samples) / median(raw):.1f} x", target


if __name__ == "__main__":
    main()
