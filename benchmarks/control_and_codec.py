"""What one control step, one judgement, one message each way and one action of the loop cost, hot."""

import timeit
from collections.abc import Callable
from itertools import count

from figures import is_quick, median, p99, print_table, verdict

from zteleop.bus import clock, codec
from zteleop.bus.loop import Loop
from zteleop.control.drive import Drive
from zteleop.control.proof import Proof
from zteleop.control.settings import SOURCES, DriveSettings
from zteleop.messages import Header, Pwm, Twist, TwistStamped

TICK_US, EPOCH, LATER = 4.0, 7, 1e-5
QUEUE = 100


class Commands:
    """A robot that five sources claim, and a time that goes on by 10 us whenever it is asked for."""

    def __init__(self, command: Twist | Pwm) -> None:
        self._command, self._ticks = command, count(1)
        self.drive = Drive(DriveSettings(), TICK_US, EPOCH, 0.0)
        for source in SOURCES:
            self.receive(source)

    def now(self) -> float:
        return 1.0 + LATER * next(self._ticks)

    def receive(self, source: str = "web") -> None:
        now = self.now()
        sender = list(SOURCES).index(source)
        proof = Proof(sender, next(self._ticks), EPOCH, now, now, 1.0)
        assert self.drive.receive(source, self._command, proof, now) is None

    def step(self) -> None:
        self.drive.step(self.now())


def main() -> None:
    quick = is_quick(__doc__)
    batches, repeats = (10, 200) if quick else (200, 500)
    twists, pwms = Commands(Twist.planar(0.3, 0.2)), Commands(Pwm(400, 380))
    loop = Loop(before_each=lambda: None)
    message = TwistStamped(Header(clock.stamp(), "base_link"), Twist.planar(0.123456, 0.654321))
    payload, encoding = codec.encode(message), codec.encoding_of(TwistStamped)
    accepted = codec.decoders([TwistStamped])
    proof = Proof(2**52, 12345, 2**52 - 1, 1234.5678, 1234.5, 1230.1)
    packed = codec.pack_proof(proof)

    def say() -> None:
        codec.encode(message)
        codec.pack_proof(proof)

    def hear() -> None:
        codec.decode(payload, encoding, accepted)
        codec.unpack_proof(packed)

    def wake() -> None:
        loop.call_soon(lambda: None)
        loop.run_once()

    def wake_for_many() -> None:
        for _ in range(QUEUE):
            loop.call_soon(lambda: None)
        loop.run_once()

    measured: list[tuple[str, Callable[[], object], int, float | None]] = [
        ("step, gate to servo, five sources claim: twist", twists.step, 1, 25.0),
        ("step, gate to servo, five sources claim: pwm", pwms.step, 1, 25.0),
        ("receive and judge: twist", twists.receive, 1, None),
        ("receive and judge: pwm", pwms.receive, 1, None),
        ("out: encode TwistStamped + pack_proof", say, 1, 1.5),
        ("in: decode TwistStamped + unpack_proof", hear, 1, 1.5),
        ("loop: wake for one action", wake, 1, None),
        (f"loop: each of {QUEUE} actions that wait", wake_for_many, QUEUE, None),
        ("(an empty call)", lambda: None, 1, None),
    ]
    samples: list[list[float]] = [[] for _ in measured]
    for _ in range(batches):
        for (_, action, actions, _), taken in zip(measured, samples, strict=True):
            runs = max(1, repeats // actions)
            taken.append(1e6 * timeit.timeit(action, number=runs) / runs / actions)
    loop.close()
    rows = [
        (name, median(taken), p99(taken), verdict(median(taken), most, "us") if most else "")
        for (name, _, _, most), taken in zip(measured, samples, strict=True)
    ]
    print_table(f"us each; {batches} batches in turn", ["what", "p50", "p99", "target"], rows)
    print(f"TwistStamped: {len(payload)} bytes, its proof {len(packed)}")


if __name__ == "__main__":
    main()
