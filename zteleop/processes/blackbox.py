"""The black box of a robot: its watchdog starts it once the actuator steps."""

import os
import signal
import sys
from contextlib import suppress
from pathlib import Path

import msgspec

from zteleop import config
from zteleop.bus.node import Node
from zteleop.bus.presence import RECORDER
from zteleop.bus.session import open_session
from zteleop.bus.tap import Tap
from zteleop.bus.topics import TOPICS
from zteleop.config import Config
from zteleop.machine import signals
from zteleop.nodes.blackbox import BlackBox, Writer
from zteleop.nodes.history import serve_history
from zteleop.processes import PROGRAMS
from zteleop.recording.ring import Ring

PROGRAM = PROGRAMS["blackbox"]
NICE = 10


def run() -> int:
    """Keep what is said of a robot, with the settings in the first line of stdin, until stdin ends."""
    _stand_back()
    ear = sys.stdin.fileno()
    settings = msgspec.json.decode(_line(ear), type=Config)
    robot = settings.robot or ""
    known = _paths(settings)
    # Whoever sees that it is there counts on being heard, and may end it at once. So it says so last, and a
    # signal that comes before waits.
    signal.pthread_sigmask(signal.SIG_BLOCK, signals.ENDING)
    session = open_session(settings.bus)
    tap = Tap(session, robot, known)
    with Node(RECORDER, robot, session=session) as node:
        for number in signals.ENDING:
            signal.signal(number, lambda *_: node.stop())
        signal.pthread_sigmask(signal.SIG_UNBLOCK, signals.ENDING)
        writer = Writer(robot, config.state_folder(robot) / "blackbox")
        ring = Ring(known)
        serve_history(node, ring)
        BlackBox(node, tap, ring, writer, ear, node.log.warn).run()
    return 0


def _paths(settings: Config) -> list[str]:
    """Return every path that somebody at the robot obeys or says."""
    sources = settings.drive.known_sources
    return [
        path
        for topic in TOPICS.values()
        for path in ([f"{topic.name}/{source}" for source in sources] if topic.command else [topic.name])
    ]


def _stand_back() -> None:
    """Let everybody else run first, and be the first to go when memory is short."""
    with suppress(OSError):
        os.nice(NICE)
    with suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text(str(PROGRAM.oom_score))


def _line(file: int) -> bytes:
    """Return the first line; what follows is left to be read."""
    with open(file, "rb", buffering=0, closefd=False) as stream:
        return stream.readline()
