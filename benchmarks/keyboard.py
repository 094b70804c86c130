"""What the keyboard's screen costs: until it is there, while nobody touches a key, and for each key."""

import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import sys
import termios
import time

from figures import is_quick, median, p99, paced, print_table, verdict
from idle_cost import cpu_seconds, private_mb
from robot import Robot

from zteleop.terminal.keys import KeyParser

ANSWERS = {b"\x1b[c": b"\x1b[?62;22c", b"\x1b[?u": b"\x1b[?15u"}
"""What a terminal that tells releases says to what it is asked."""
QUESTION = re.compile(rb"\x1b\[(?:c|\?u)")
KEYS = b"\x1b[119;1:1u\x1b[119;1:2u\x1b[122::119;1:3u\x1b[1;1:1A\x1b[1;1:3Aw"


class Seat:
    """A terminal with a keyboard's screen, which answers as real ones do."""

    def __init__(self, robot: Robot) -> None:
        self._master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 30, 100, 0, 0))
        self._began = time.monotonic()
        words = ("--connect", robot.endpoint)
        self.process = robot.start("keyboard", *words, stdin=slave, stdout=slave, start_new_session=True)
        os.close(slave)
        self._seen = b""

    def first_screen(self) -> float:
        """Return the seconds until the screen stood, with the robot on it or not yet."""
        while b"steering" not in self._seen:
            self.look(1.0)
        return time.monotonic() - self._began

    def look(self, seconds: float) -> None:
        """Read what is shown, and answer what is asked, for so long or until something came."""
        if select.select([self._master], [], [], seconds)[0]:
            data = os.read(self._master, 65536)
            self._seen += data
            for question in QUESTION.findall(data):
                os.write(self._master, ANSWERS[question])

    def rest(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.look(left)

    def close(self) -> None:
        os.write(self._master, b"\x1b[113u")
        self.process.wait(10)
        os.close(self._master)


def parser_us(rounds: int) -> float:
    """Return what one event of a key costs the parser."""
    parser, began = KeyParser(), time.perf_counter()
    for _ in range(rounds):
        parser.feed(KEYS)
    return (time.perf_counter() - began) / rounds / 6 * 1e6


def python_ms() -> float:
    """Return what a bare Python takes from start to end."""
    began = time.perf_counter()
    subprocess.run([sys.executable, "-c", "pass"], check=True)
    return 1000 * (time.perf_counter() - began)


def main() -> None:
    quick = is_quick(__doc__ or "")
    pythons, starts, shares, memory = [], [], [], 0.0
    with Robot() as robot:
        for turn in range(3 if quick else 15):
            pythons.append(python_ms())
            seat = Seat(robot)
            starts.append(seat.first_screen() * 1000)
            if turn == 0:
                seat.rest(1.0)
                for _ in range(1 if quick else 5):
                    before, began = cpu_seconds(seat.process), time.monotonic()
                    seat.rest(2.0)
                    shares.append(100 * (cpu_seconds(seat.process) - before) / (time.monotonic() - began))
                memory = private_mb(seat.process)
            seat.close()
    parsed = [parser_us(2000) for _ in range(5)]
    first = paced(150, median(pythons))
    rows = [
        ("(python -c pass, ms)", median(pythons), max(pythons), ""),
        ("until the screen stands, ms", median(starts), p99(starts), verdict(median(starts), first, "ms")),
        ("one core while idle, %", median(shares), max(shares), verdict(median(shares), 1, "%")),
        ("memory of its own, MB", memory, memory, verdict(memory, 18, "MB")),
        ("parser, us an event", median(parsed), max(parsed), verdict(median(parsed), 2, "us")),
    ]
    print_table("The keyboard's screen", ("", "median", "p99", "target here"), rows)


if __name__ == "__main__":
    main()
