"""How we stand beside others, landing by landing: a row of ratios in history.csv, and what has become worse.

A ratio is taken on one machine, in one run, beside a peer that runs in turn; so it can be compared where
milliseconds cannot. Rows of other machines are not looked at.
"""

import csv
import os
import platform
import subprocess
import sys
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import idle_cost
import key_to_wheel
import publish_to_handler
import shell
from figures import command_line, median, print_table

FILE = Path(__file__).with_name("history.csv")
LAST, WORSE = 5, 1.2
"""rows that a ratio is compared with, and how many times the best of them it may be"""
ABOUT = ("date", "commit", "machine")


def measure(quick: bool) -> dict[str, float]:
    """Return each ratio; the smaller the better."""
    rounds = 1 if quick else 8
    keys, raw_keys = key_to_wheel.time_lines(rounds)
    ways = publish_to_handler.time_ways(rounds, 100)
    times = {name: median(taken) for name, taken in shell.time_commands(3 if quick else 15).items()}
    costs = idle_cost.measure(2.0 if quick else 10.0)
    robot, subscriber, peer = idle_cost.in_all(costs), costs[idle_cost.SUBSCRIBED], costs[idle_cost.PEER]
    return {
        "key to wheel / raw": median(keys) / median(raw_keys),
        "publish to handler / raw": median(ways["zteleop"]) / median(ways["raw"]),
        "echo --once / raw": times["zteleop echo --once"] / times[shell.PEER],
        "--help / python": times["zteleop --help"] / times[shell.PYTHON],
        "list / raw echo": times["zteleop list"] / times[shell.PEER],
        "robot at rest / raw subscriber": robot.idle / peer.idle,
        "robot driven / raw subscriber": robot.driven / peer.idle,
        "subscriber / raw subscriber": subscriber.idle / peer.idle,
        "memory of the robot / raw subscriber": robot.mb / peer.mb,
    }


def machine() -> str:
    """Return what a row may be compared by."""
    return f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}"


def rows(path: Path) -> list[dict[str, str]]:
    """Return the rows kept, the oldest first."""
    if not path.exists():
        return []
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def keep(path: Path, ratios: dict[str, float]) -> None:
    """Add a row for the present commit; a ratio that is new gets a column."""
    before = rows(path)
    commit = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=True
    )
    about = dict(zip(ABOUT, (f"{datetime.now(UTC):%Y-%m-%d}", commit.stdout.strip(), machine()), strict=True))
    row = about | {name: f"{ratio:.3g}" for name, ratio in ratios.items()}
    columns = list(dict.fromkeys([*ABOUT, *(name for one in before for name in one), *row]))
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, columns, restval="")
        writer.writeheader()
        writer.writerows([*before, row])


def best(before: list[dict[str, str]], name: str) -> float | None:
    """Return the best of the last rows; None where none has that ratio."""
    found = [float(row[name]) for row in before[-LAST:] if row.get(name)]
    return min(found, default=None)


def compare(ratios: dict[str, float], before: list[dict[str, str]], say: Callable[[str], object]) -> bool:
    """Say which ratios are worse than they were; True when none is."""
    worse = [
        f"{name}: {ratio:.3g}, and {was:.3g} at best in the last {LAST}"
        for name, ratio in ratios.items()
        if (was := best(before, name)) is not None and ratio > WORSE * was
    ]
    for words in worse:
        say(f"worse by more than {100 * (WORSE - 1):.0f} %: {words}")
    return not worse


def main() -> int:
    parser = command_line(__doc__)
    parser.add_argument("--keep", action="store_true", help="add a row to history.csv")
    arguments = parser.parse_args()
    before = [row for row in rows(FILE) if row["machine"] == machine()]
    ratios = measure(arguments.quick)
    table = [(name, ratio, best(before, name) or "") for name, ratio in ratios.items()]
    print_table(f"beside others, {machine()}", ["ratio", "now", f"best of the last {LAST}"], table)
    well = compare(ratios, before, print)
    if arguments.keep:
        keep(FILE, ratios)
    return int(not well)


if __name__ == "__main__":
    sys.exit(main())
