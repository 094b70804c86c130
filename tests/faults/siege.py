"""Half an hour of all that strangers do, at random: does the robot hold, and is anything left of it?

`python -m faults.siege --minutes 30`; with `--without none` no declaration breaks the door, which then
lives as long as the siege.
"""

import argparse
import random
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from faults.usage import Usage, told, usage
from rig import free_port

from zteleop.chaos.bench import Bench, Subject
from zteleop.chaos.operators import PERIOD
from zteleop.chaos.people import press
from zteleop.chaos.process import ZTELEOP, Process, door_of
from zteleop.chaos.stranger import ATTACKS
from zteleop.chaos.strangers import begin
from zteleop.config import Config
from zteleop.messages import Twist

MOST, MOST_OF_DOOR = 10.0, 20.0
"""MB that a process may grow from one quiet moment to another; a door is compared with itself alone"""
ROUND, QUIET = 120.0, 15.0
"""s of attacks, and s of none after which the memory is looked at"""
TURN = 5.0
"""s between two changes: one attack ends, or one begins"""
AT_ONCE = 4
STOP_EVERY, STOPS_WITHIN = 30.0, 30.0
RELEASE_EVERY = 0.5
PAUSES_AFTER = 2.0
"""s at rest after which somebody lets go of the key and presses it again"""
AGAIN, BOUND = 10.0, 0.05
"""s after the last attack's end until it is driven again; s from a stop to rest when nobody attacks"""


@contextmanager
def person(bench: Bench) -> Iterator[None]:
    """Drive as a person does: 50 times a second, and begin anew after having waited for a while."""
    motors, ended = bench.node.publisher("cmd_vel", Twist, source="keyboard"), threading.Event()

    def drive() -> None:
        moved = time.monotonic()
        while not ended.wait(PERIOD):
            now = time.monotonic()
            moved = moved if bench.eye.at_rest else now
            if now - moved > PAUSES_AFTER:
                motors.let_go()
                moved = now
            motors.publish(bench.command)

    thread = threading.Thread(target=drive, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


class Siege:
    """Strangers who come and go, a robot that is driven meanwhile, and somebody who stops it now and then."""

    def __init__(self, bench: Bench, endpoint: str, dice: random.Random, attacks: list[str]) -> None:
        self.bench, self.endpoint, self.dice, self.attacks = bench, endpoint, dice, attacks
        self.begun, self.stops, self.doors = 0, 0, 0
        self.unheard: list[str] = []
        """stops that were not confirmed"""
        self.looks, self.driven = 0, 0
        self._under_way: dict[str, Process] = {}
        self._door = bench.door
        self._where = [
            *("--robot", bench.place.robot, "--mode", "client", "--no-multicast-scouting"),
            *("--connect", endpoint),
        ]

    def is_driven(self) -> bool:
        """Say whether it moves, having released what stops it."""
        self._release()
        return not self.bench.eye.at_rest

    def round(self, seconds: float) -> None:
        """Attack for a while, and end all attacks."""
        end = time.monotonic() + seconds
        while (now := time.monotonic()) < end:
            self._turn()
            if self.begun % round(STOP_EVERY / TURN) == 1:
                self._stop()
            self._watch(now + TURN)
        for attack in list(self._under_way):
            self._under_way.pop(attack).end()

    def _turn(self) -> None:
        attack = self.dice.choice(self.attacks)
        if len(self._under_way) == AT_ONCE:
            attack = self.dice.choice(list(self._under_way))
        if process := self._under_way.pop(attack, None):
            process.end()
        else:
            self.begun += 1
            self._under_way[attack] = begin(attack, self.bench, self.endpoint, f"stranger-{self.begun}")

    def _stop(self) -> None:
        """Stop it from a fresh process, as a bystander does, and let it drive again."""
        self.stops += 1
        stop = self.bench.run(f"stop-{self.stops}", [*ZTELEOP, "stop", *self._where])
        self.bench.until(lambda: stop.ended, STOPS_WITHIN)
        if stop.code != 0:
            self.unheard.append(f"{stop.words} (during {', '.join(self._under_way)})")

    def _watch(self, end: float) -> None:
        release_at = 0.0
        while (now := time.monotonic()) < end:
            self.looks, self.driven = self.looks + 1, self.driven + (not self.bench.eye.at_rest)
            door = door_of(self.bench.watchdog.pid)
            if door and door != self._door:
                self._door, self.doors = door, self.doors + 1
            if now > release_at:
                release_at = now + RELEASE_EVERY
                self._release()
            time.sleep(0.01)

    def _release(self) -> None:
        status = self.bench.status
        for stop in status.stops if status else ():
            self.bench.release(stop.id)


def besiege(bench: Bench, siege: Siege, minutes: float) -> list[str]:
    """Attack in rounds, looking at the robot after each; return what fell short."""
    first: dict[str, Usage] = {}
    began, short = time.monotonic(), []
    while (passed := time.monotonic() - began) < 60 * minutes:
        siege.round(ROUND)
        ended = time.monotonic()
        again = bench.until(siege.is_driven, AGAIN)
        if again is None:
            short.append(f"not driven again within {AGAIN:g} s: {bench.status}")
        time.sleep(QUIET)
        newest = usage(bench.watchdog.pid)
        first = first or newest
        if (door := newest.get("door")) and door.pid not in {own.pid for own in first.values()}:
            first["door"] = door
        took = f"{again - ended:.2f} s" if again else "never"
        print(f"{passed / 60:5.1f} min: {told(newest)}, driven again: {took}", flush=True)
        short += list(differences(first, newest))
    return [*short, *siege.unheard]


def differences(first: dict[str, Usage], newest: dict[str, Usage]) -> Iterator[str]:
    """Say what a robot has lost, or has taken and kept, between two quiet moments."""
    for name in sorted(first.keys() | newest.keys()):
        before, now = first.get(name), newest.get(name)
        if not before or not now:
            yield f"there is {'no longer a' if before else 'now a'} {name}"
            continue
        if before.pid != now.pid:
            yield f"the {name} is another"
        if now.mb > before.mb + (MOST_OF_DOOR if name == "door" else MOST):
            yield f"the {name} has grown from {before.mb:.1f} to {now.mb:.1f} MB"
        if now.files > before.files:
            yield f"the {name} had {before.files} files open, and has {now.files}"
        if now.threads > before.threads:
            yield f"the {name} had {before.threads} threads, and has {now.threads}"


def main() -> int:
    """Return 0 when it held, was driven again each time, and kept nothing."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--seed", type=int, default=random.randrange(1000))
    parser.add_argument("--without", metavar="TEXT", default="", help="no attack whose name holds this")
    arguments = parser.parse_args()
    attacks = [name for name in ATTACKS if not arguments.without or arguments.without not in name]
    print(f"seed {arguments.seed}", flush=True)
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    options = ("--driver", "simulated", "--listen", endpoint)
    with Bench(Subject(Config(), options)) as bench:
        bench.await_ready()
        with person(bench):
            bench.until(lambda: not bench.eye.at_rest, 10.0)
            time.sleep(5.0)  # until the black box is there as well
            siege = Siege(bench, endpoint, random.Random(arguments.seed), attacks)
            short = besiege(bench, siege, arguments.minutes)
            struck = time.monotonic()
            press(bench)
            stopped = bench.until(lambda: bench.eye.at_rest, 5.0)
    took = (stopped or float("inf")) - struck
    if took > BOUND:
        short.append(f"at the end it stopped within {took:.3f} s, not {BOUND:g}")
    print(f"{siege.begun} attacks, driven {100 * siege.driven / siege.looks:.0f} % of the time")
    print(f"{siege.stops} stops, {siege.doors} doors ended, the last stop took {1000 * took:.1f} ms")
    for what in dict.fromkeys(short):
        print(f"FELL SHORT: {what}")
    return 1 if short else 0


if __name__ == "__main__":
    sys.exit(main())
