import argparse
import os
import re
import sys
from collections.abc import Iterator
from datetime import UTC, datetime

from zteleop.bus import presence
from zteleop.bus.escape import printable
from zteleop.bus.names import resolve
from zteleop.bus.node import Node
from zteleop.cli import _company, _options
from zteleop.errors import BusError
from zteleop.messages import DriveStatus, Odometry, WatchdogStatus, Why

EXAMPLES = (
    "zteleop why",
    "zteleop why archangel",
)
PAST = " if it failed, zteleop blackbox on the robot tells how"
IS = {
    "link lost": "has lost touch with its driver",
    "operator idle": "waits for an act",
    "fault": "has a fault",
}
"""states that are no word behind `is`"""
UNPLACED = "nobody says where it is: zteleop sim moves a simulated robot; zteleop odometry is for any other"
STANDS = "says that it stands: something is in its way, its motor does not turn yet, or it has just begun"
SILENT = " has been silent for "
SELDOM = "its link is lost, or it speaks too seldom: a program must speak twice a second, better ten times"
"""what silence may be: nobody who hears nothing can tell which"""
ROLLS, STANDS_BELOW = 0.05, 0.01
"""m/s that are asked of wheels, and that nobody sees"""
HEARD_WITHIN = 2.0
TELL_AFTER = 1.0
"""s of that until it says for whom it waits"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    _options.add_robot(parser)


def run(arguments: argparse.Namespace) -> None:
    with _options.join("why", _options.load_anyhow(arguments)) as node:
        try:
            print(answer(node))
        except BusError as error:
            if not sys.stdout.isatty() and not _are_one(1, 2):  # kept in a file, it is the answer as well
                print(printable(f"{error} (at {_moment()})"))
            raise


def _are_one(one: int, other: int) -> bool:
    """Say whether two files of this process are the same, as behind 2>&1."""
    try:
        return os.path.sameopenfile(one, other)
    except OSError:
        return False


def answer(node: Node) -> str:
    """Return a line for the robot and one for each layer between a key and a wheel."""
    odoms = node.subscription("odom", Odometry)
    statuses, whys = node.subscription("drive_status", DriveStatus), node.subscription("why", Why)
    dogs = node.subscription("watchdog", WatchdogStatus)
    status, why, dog = None, None, None

    def complete() -> bool:
        nonlocal status, why, dog
        status, why = statuses.newest() or status, whys.newest() or why
        dog = dogs.newest() or dog
        return bool(status and why and dog)

    if not node.membership.until(complete, TELL_AFTER) and status is None and dog is None:
        here = presence.here(node.membership.session, node.robot)
        print(printable(f"zteleop why: waits for {node.robot}; {here}"), file=sys.stderr, flush=True)
    node.membership.until(complete, HEARD_WITHIN - TELL_AFTER)
    if status is None and dog is None:
        raise BusError(f"no actuator of {node.robot} is heard within {HEARD_WITHIN:g} s; is it on?{PAST}")
    lines = [headline(node.robot or "", status, why) if status else f"{node.robot}: no actuator heard"]
    lines += [f"  {layer.name:9} {layer.says}" for layer in (why.layers if why else [])]
    lines.append(f"  {'watchdog':9} {state_of(dog) if dog else 'is not heard'}")
    if status and status.state == "link lost" and SILENT in status.why:
        lines.append(f"  {'link':9} {SELDOM}")
    if status and not _is_placed(node):
        lines.append(f"  {'odom':9} {UNPLACED}")
    elif status and _stands(status, odoms.newest()):
        lines.append(f"  {'odom':9} {STANDS}")
    lines += [f"  {'who':9} {who}" for who in named("\n".join(lines), node)]
    lines.append(f"  {'at':9} {_moment()}")
    return "\n".join(map(printable, lines))


def headline(robot: str, status: DriveStatus, why: Why | None) -> str:
    """Return what a robot does; of one whose wheels do not turn although somebody drives, why not."""
    words = f"{robot} {IS.get(status.state, f'is {status.state}')}: {status.why}"
    limits = next((layer.says for layer in why.layers if layer.name == "limiter"), "") if why else ""
    rests = abs(status.applied.linear.x) < STANDS_BELOW and abs(status.applied.angular.z) < STANDS_BELOW
    if status.state == "driving" and status.wanted.moves and rests and limits:
        return f"{words}, and it stands: the limiter {limits}"
    return words


def _is_placed(node: Node) -> bool:
    """Say whether anybody says where the robot is."""
    endpoints = presence.endpoints(node.membership.session)
    return bool(_company.members(resolve("odom", node.robot), "pub", endpoints))


def _stands(status: DriveStatus, odom: Odometry | None) -> bool:
    """Say whether a robot whose wheels are to turn is where it was."""
    to_roll = status.state == "driving" and abs(status.applied.linear.x) >= ROLLS
    return to_roll and odom is not None and abs(odom.twist.twist.linear.x) < STANDS_BELOW


def _moment() -> str:
    return f"{datetime.now(UTC):%Y-%m-%d %H:%M:%S} UTC"


def named(text: str, node: Node) -> Iterator[str]:
    """Yield which node each sender is that a text calls by its last digits."""
    for sender, one in sorted(presence.senders(node.membership.session, node.robot or "").items()):
        if found := re.search(rf"\b[a-z_]\w* {sender[-4:].zfill(4)}\b", text):
            host, _, number = one.process.rpartition("-")
            yield f"{found[0]} is {one.node}, process {number} on {host}"


def state_of(dog: WatchdogStatus) -> str:
    """Return what a watchdog sees, in a line."""
    sees = "pulses off neutral" if dog.moving else "pulses of rest"
    permits = "commands that allow motion" if dog.allowed else "no command that allows motion now"
    if dog.allowed and not dog.moving:
        permits = "commands that it would let pass"
    # said in step with the actuator, so that the very figure would always be the same one
    last = "within the last 50 ms" if dog.silence < 0.05 else f"last {dog.silence * 1000:.0f} ms ago"
    steps = f"{dog.why}, {last}" if dog.state == "watching" else dog.why
    restarts = f"; {dog.restarts} restart{'s'[: dog.restarts - 1]}" if dog.restarts else ""
    return f"{dog.state}: {steps}; sees {sees}, and hears {permits}{restarts}"
