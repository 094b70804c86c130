"""From a key byte in a terminal to the registers of the chip, two processes apart, seen from outside."""

import sys

from figures import is_quick, median, p99, print_table, verdict
from own_share import own_share
from robot import RAW_LINE, Operator, RawRobot, Robot

TARGET, OWN_TARGET = 1.5, 0.15
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
    share = own_share(40 if quick else 500)
    own = [keyboard + actuator for keyboard, actuator in zip(share.keyboard, share.actuator, strict=True)]
    print_table(
        f"key to wheel, ms, {len(ours)} presses",
        ["line", "p50", "p90", "p99", "of raw", "target for p50"],
        [
            _row("zteleop keyboard -> zteleop actuator", ours, raw, verdict(median(ours), TARGET, "ms")),
            _row("peer: terminal -> raw zenoh -> registers", raw, raw, ""),
        ],
    )
    print_table(
        f"zteleop's own share, ms, {len(own)} presses",
        ["part", "p50", "p99", "target for p50"],
        [
            ("teleop: bytes in hand -> put", median(share.keyboard), p99(share.keyboard), ""),
            ("actuator: sample in hand -> I2C write done", median(share.actuator), p99(share.actuator), ""),
            ("sum", median(own), p99(own), verdict(median(own), OWN_TARGET, "ms")),
            ("(after the put: one frame of the screen)", median(share.draw), p99(share.draw), ""),
        ],
    )


def _row(name: str, samples: list[float], raw: list[float], target: str) -> tuple[object, ...]:
    p90 = sorted(samples)[int(0.9 * len(samples))]
    return name, median(samples), p90, p99(samples), f"{median(samples) / median(raw):.1f} x", target


if __name__ == "__main__":
    main()
