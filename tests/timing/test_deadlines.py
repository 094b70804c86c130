"""Who falls silent brings neutral, between real processes, measured at the chip from outside."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from rig import NEUTRAL, Process, Rig, every, hear, until
from verdict import Deadline

from zteleop.bus.node import Node
from zteleop.chaos.cable import Cable
from zteleop.machine import realtime
from zteleop.messages import DriveStatus, Pwm

FORWARD = Pwm(390, 400)
PATTERN = (390, 400)
SILENCE = 0.3
MARGIN = 0.07
"""s: a beat's age, and a step of the robot"""
WAKES = 0.05
"""s until a watchdog that stood still is at work again, and with it its robot at rest"""


class Operator:
    """Says one command 50 times a second from a thread, with or without acts, until told otherwise."""

    def __init__(self, node: Node, source: str = "keyboard", acts: bool = True) -> None:
        self._publisher = node.publisher("pwm", Pwm, source=source)
        self._node, self._acts = node, acts
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._publisher.act()
        self._thread.start()

    def act(self) -> None:
        self._publisher.act()

    def end(self) -> None:
        self._ended.set()
        self._thread.join()

    def _run(self) -> None:
        realtime.follow()
        while not self._ended.wait(0.02):
            if self._acts:
                self._publisher.act()
            self._publisher.repeat(FORWARD)


@contextmanager
def operator(node: Node, **options: bool) -> Iterator[Operator]:
    it = Operator(node, **options)
    try:
        yield it
    finally:
        it.end()


def driven(rig: Rig) -> None:
    until(lambda: rig.ticks == PATTERN, "the command on the chip")


def rests(rig: Rig) -> bool:
    return rig.ticks == NEUTRAL


@pytest.fixture
def program(rig: Rig) -> Process:
    """A sender in a process of its own: `zteleop pub` as source `keyboard`, 50 times a second."""
    rig.actuator()
    values = f"{{steering_ticks: {FORWARD.steering_ticks}, throttle_ticks: {FORWARD.throttle_ticks}}}"
    sender = rig.join("pub", "pwm/keyboard", "Pwm", values, "-r", "50")
    driven(rig)
    return sender


def test_a_killed_sender(rig: Rig, program: Process) -> None:
    deadline = Deadline(rig)
    program.signal(signal.SIGKILL)
    deadline.met(lambda: rests(rig), "neutral", SILENCE + MARGIN)


def test_a_frozen_sender_and_its_return(rig: Rig, program: Process) -> None:
    deadline = Deadline(rig)
    program.signal(signal.SIGSTOP)
    deadline.met(lambda: rests(rig), "neutral", SILENCE + MARGIN)
    program.signal(signal.SIGCONT)
    driven(rig)


def test_a_cut_link(rig: Rig) -> None:
    rig.actuator()
    with Cable(rig.port) as cable:
        node = rig.node(port=cable.port)
        rig.hear(node)
        with operator(node):
            driven(rig)
            deadline = Deadline(rig)
            cable.cut()
            deadline.met(lambda: rests(rig), "neutral", SILENCE + MARGIN)
            for _ in every(0.02, 125):
                assert rig.ticks == NEUTRAL
            cable.mend()
            for _ in every(0.02, 100):  # what was queued arrives now, and what the operator still says
                assert rig.ticks == NEUTRAL


def test_an_idle_operator_and_the_next_act(rig: Rig) -> None:
    rig.actuator()
    node = rig.node()
    rig.hear(node)
    deadline = Deadline(rig)
    with operator(node, acts=False) as it:
        driven(rig)
        deadline.met(lambda: rests(rig), "neutral", 5.0 + MARGIN, not_before=4.9)
        it.act()
        driven(rig)


def test_stale_commands_never_move_the_robot(rig: Rig) -> None:
    """The actuator stands still for 3 s under a stream; resumed, and the stream cut, it must not move."""
    actuator = rig.actuator()
    with Cable(rig.port) as cable:
        node = rig.node(port=cable.port)
        rig.hear(node)
        with operator(node):
            driven(rig)
            actuator.signal(signal.SIGSTOP)
            for _ in every(0.02, 150):
                pass
            cable.cut()
            deadline = Deadline(rig)
            actuator.signal(signal.SIGCONT)
            deadline.met(lambda: rests(rig), "neutral", WAKES)
            for _ in every(0.001, 2000):
                assert rig.ticks == NEUTRAL


def test_a_robot_whose_watchdog_stood_still_for_long_waits_until_the_operator_lets_go(rig: Rig) -> None:
    actuator = rig.actuator()
    node = rig.node()
    rig.hear(node)
    statuses = node.subscription("drive_status", DriveStatus)
    with operator(node):
        driven(rig)
        actuator.signal(signal.SIGSTOP)
        for _ in every(0.02, 150):  # its actuator went on for half a second of that, and another starts
            pass
        deadline = Deadline(rig)
        actuator.signal(signal.SIGCONT)
        deadline.met(lambda: rests(rig), "neutral", WAKES)
        actuator.says("let go first")
        for _ in every(0.02, 50):
            assert rig.ticks == NEUTRAL
    # Another actuator may need longer to start and be heard; who begins before that must begin anew.
    hear(statuses, lambda status: status.state == "idle", "a robot that is heard again")
    with operator(node):
        driven(rig)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_an_actuator_that_is_told_to_end_leaves_neutral(rig: Rig, number: int) -> None:
    actuator = rig.actuator()
    node = rig.node()
    rig.hear(node)
    with operator(node):
        driven(rig)
        actuator.signal(number)
        assert actuator.ends() == 128 + number
    assert rig.ticks == NEUTRAL
