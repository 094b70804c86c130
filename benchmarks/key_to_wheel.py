"""From a key byte in a terminal to the registers of the chip, two processes apart, seen from outside."""

import sys
from contextlib import ExitStack

from figures import command_line, median, p99, print_table, verdict
from processes import running
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
    parser = command_line(__doc__)
    parser.add_argument("--busy", type=int, default=0, metavar="N", help="beside so many busy processes")
    options = parser.parse_args()
    with ExitStack() as stack:
        for _ in range(options.busy):
            stack.enter_context(running([sys.executable, "-c", "while True: pass"]))
        ours, raw = time_lines(1 if options.quick else 15)
    print_table(
        f"key to wheel, ms, {len(ours)} presses, {options.busy} busy processes beside",
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
