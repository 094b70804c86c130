"""Somebody who drives from another machine: every command tells by its pulses when it was sent.

python -m faults.link.sender ROBOT ENDPOINT [--mode client] [--rate 20] [--standing]

SIGUSR1 lets go for a moment and then begins anew. Each line says when the robot was last heard.
"""

import argparse
import signal
import sys
import time
from types import FrameType

from faults.link.timecode import encode

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.settings import BusSettings
from zteleop.messages import Pwm

REST = Pwm(375, 370)
LETS_GO = 0.1
"""s at rest before it begins anew"""
TELL_EVERY = 0.1
PATIENCE = 60.0


class Operator:
    """Says a command at a rate; each is an act, or, when it is a standing one, none but the first."""

    def __init__(self, node: Node, *, standing: bool) -> None:
        self._heard, self._standing = node.membership.heard(), standing
        self._motors = node.publisher("pwm", Pwm, source="keyboard")
        self._rests_until = 0.0
        self._acts = True

    def let_go(self, number: int, frame: FrameType | None) -> None:
        self._rests_until, self._acts = time.monotonic() + LETS_GO, True

    def command(self) -> None:
        now = time.monotonic()
        command = REST if now < self._rests_until else Pwm(*encode(now))
        if command == REST or self._acts:
            self._motors.publish(command)
            self._acts = command == REST or not self._standing
        else:
            self._motors.repeat(command)

    def tell(self) -> None:
        """Say when the newest beat arrived, and how long it was under way where both are one machine."""
        if self._heard.beat:
            late = self._heard.at - self._heard.beat.time
            ago = clock.now() - self._heard.at
            sys.stdout.write(f"heard {time.monotonic() - ago:.4f} {late:.4f}\n")
            sys.stdout.flush()


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("robot")
    parser.add_argument("endpoint")
    parser.add_argument("--mode", choices=["peer", "client"], default="peer")
    parser.add_argument("--rate", type=float, default=50.0)
    parser.add_argument("--standing", action="store_true")
    options = parser.parse_args()
    bus = BusSettings(mode=options.mode, connect=[options.endpoint], multicast=False, patience=PATIENCE)
    with Node("operator", options.robot, bus) as node:
        operator = Operator(node, standing=options.standing)
        signal.signal(signal.SIGUSR1, operator.let_go)
        node.every(1 / options.rate)(operator.command)
        node.every(TELL_EVERY)(operator.tell)
        node.spin()


if __name__ == "__main__":
    main()
