"""The process above the actuator: it believes only what it hears and reads itself."""

import signal
import time
from collections.abc import Callable
from types import FrameType
from typing import Literal

from zteleop.bus import clock
from zteleop.bus.lane.ear import Ear, Heard
from zteleop.bus.lane.wire import Answered
from zteleop.bus.node import Node
from zteleop.bus.topics import TOPICS
from zteleop.control.deadlines import GRACE, STEADY_EVERY, STEP_EVERY
from zteleop.control.judge import Judge
from zteleop.control.patience import Patience
from zteleop.control.settings import DriveSettings
from zteleop.control.standing import Standing
from zteleop.drivers import PulseDriver
from zteleop.errors import DeviceError
from zteleop.machine import signals, systemd
from zteleop.machine.child import Child
from zteleop.machine.ids import new_id
from zteleop.machine.link import CUT, HEARS, HEARS_NOT, UNWATCHED
from zteleop.machine.sidecar import Recorder
from zteleop.machine.stop_file import StopFile
from zteleop.messages import Confirmed, Stop, WatchdogStatus
from zteleop.nodes.hand import Hand
from zteleop.nodes.overhear import Overhearing

BEAT_EVERY = LOOK_EVERY = 0.05
_LONGEST = 200
"""characters of a reason in an answer"""
ENDS_WITHIN = 0.25
RESTS_WITHIN = 2.0


class Watchdog:
    """Starts the actuator, watches it and the chip, and writes neutral when either is not as it must be."""

    def __init__(
        self,
        node: Node,
        settings: DriveSettings,
        chip: PulseDriver,
        child: Child,
        stop_file: StopFile,
        enable: Callable[[bool], bool] = lambda on: False,
        recorder: Recorder | None = None,
        lane: Ear | None = None,
    ) -> None:
        self._node = node
        self._child = child
        self._stop_file = stop_file
        self._recorder = recorder
        self._lane = lane
        self._judge = Judge(settings, chip.tick_us, clock.now())
        self._hand = Hand(chip, enable, self._judge)
        self._ears = Overhearing(node, settings, self._judge, stop_file)
        self._statuses = node.publisher("watchdog", WatchdogStatus)
        self._patience = Patience(clock.now())
        self._restart_at: float | None = None
        """When the next actuator starts, while there is none."""
        self._standing: Standing | None = None
        """Of the actuator that is gone, where it was only late."""
        self._why = "the actuator starts"
        self._exit_code: int | None = None

    def run(self) -> int:
        """Watch until told to end, or until the actuator cannot start; return the exit code."""
        for number in signals.ENDING:
            if signal.getsignal(number) != signal.SIG_IGN:  # which nohup wants
                signal.signal(number, self._end_by)
        words = "Ctrl-Z at the robot pauses nothing, for its wheels would turn on; Ctrl-C there ends it"
        signals.stay(lambda: self._node.membership.loop.call_soon(lambda: self._node.log.warn(words)))
        try:
            steps = self._node.membership.loop.every(
                STEP_EVERY, lambda: steps.pace(self._tick(), clock.now())
            )
            self._node.every(BEAT_EVERY)(self._beat)
            self._node.every(LOOK_EVERY)(self._look)
            self._node.every(TOPICS["watchdog"].every)(self._tell)
            self._start()
            self._node.spin()
        finally:
            self._finish()
        return self._exit_code or 0

    def _end_by(self, number: int, frame: FrameType | None) -> None:
        self._exit_code = self._exit_code or 128 + number
        self._node.stop()

    def _start(self) -> None:
        self._restart_at = None
        self._ears.forget_beats()
        self._child.start(clock.now(), self._standing)
        self._node.membership.loop.watch(self._child.fileno(), lambda: self._hear_actuator(woken=True))

    def _hear_actuator(self, woken: bool = False) -> None:
        """Take in its reports; only its end wakes anybody."""
        was_ready = self._child.ready
        try:
            self._child.hear(clock.now())
            if woken:
                raise EOFError
        except EOFError:
            self._rest()  # before its process is even waited for
            self._fell("it ended", GRACE)
            return
        if report := self._child.newest:
            self._judge.hear_report(report.standing)
            if not was_ready:
                self._greet()

    def _greet(self) -> None:
        """Let the outputs through, and tell a new actuator of stops that may be on no disk."""
        self._why = "the actuator steps"
        self._patience.restore()
        self._hand.let_through()
        for stop in self._ears.stops:
            self._tell_stop(stop)
        systemd.notify("READY=1")

    def _tick(self) -> float:
        """Take in what the bus says, and notice silence; return when to do so again, in s."""
        now = clock.now()
        self._patience.tick(now)
        if self._child.link:
            self._hear_actuator()
        for heard in self._lane.take(now) if self._lane else ():
            self._obey(heard, now)
        if ignored := self._ears.listen(now):
            self._engage(ignored)
        silence = self._child.silence(clock.now())  # `now` is older than a step that came since
        if self._restart_at is not None:
            self._keep_at_rest(now)
        elif self._patience.is_over(silence, self._hand.took, self._child.ready, now):
            self._fell(self._patience.lose(silence, self._child.ready), 0.0, late=True)
        is_busy = self._judge.moving or self._ears.floods or self._state != "watching"
        return STEP_EVERY if is_busy else STEADY_EVERY

    def _beat(self) -> None:
        report = self._child.newest
        hears = self._ears.hears(report.standing.epoch if report else None, clock.now())
        if self._child.link:
            word = HEARS if hears else HEARS_NOT
            self._child.link.send(CUT[word] if self._hand.pin_cuts else word)
        systemd.notify("WATCHDOG=1")

    def _look(self) -> None:
        """Read the chip; what moves without a reason is stopped, and what does not obey that is killed."""
        if self._restart_at is not None or not self._child.ready or not self._hand.is_due(clock.now()):
            return
        try:
            why = self._judge.look(self._hand.look(), clock.now())
        except DeviceError as error:
            self._node.log.warn(f"cannot read the chip: {error}", "read")
            if self._hand.miss():
                self._node.log.error("the chip cannot be read: its outputs are cut until it can")
            return
        if why and not self._judge.stopped:
            self._engage(Stop(engaged=True, id=new_id(), by="the watchdog", why=why))
        elif why:
            self._fell(why, 0.0)
        elif self._hand.is_cut and self._child.ready and not self._judge.moving:
            self._hand.cut(False)

    def _engage(self, stop: Stop) -> None:
        self._node.log.error(f"stops the robot: {stop.why or stop.by}")
        self._ears.engage(stop)
        self._tell_stop(stop)
        self._rest()
        self._stop_file.add(stop)  # a disk may take its time

    def _obey(self, heard: Heard, now: float) -> None:
        """Engage a stop that came without zenoh, and answer how the robot stands."""
        stop = heard.asked.stop
        if self._ears.hear_stop(stop, now):
            if not self._never_stepped:
                self._hand.write_neutral()  # the actuator, or the next look, sees to it that it stays there
            self._tell_stop(stop)
            if not self._child.link:  # nobody else keeps it
                self._stop_file.add(stop)
        holds = self._ears.holds(stop)
        confirmed = self._confirmed() if holds else ""
        unkept = "" if self._ears.keeps(stop) else self._stop_file.unkept or "it is being written"
        trouble = self._hand.trouble[:_LONGEST]
        heard.answer(Answered(heard.asked.robot, stop.id, holds, confirmed, unkept[-_LONGEST:], trouble))

    def _confirmed(self) -> Confirmed:
        """Say how a robot with a stop in force is known to stand: by a look since its actuator obeyed."""
        if self._hand.pin_cuts:
            return "cut"
        if self._restart_at is not None:
            return "read" if self._hand.at_rest else ""
        obeyed = self._child.stopped_since
        return "read" if obeyed and self._hand.seen > obeyed and not self._judge.moving else ""

    def _tell_stop(self, stop: Stop) -> None:
        if self._child.link:
            self._child.link.stop(stop)

    def _fell(self, why: str, wait: float, late: bool = False) -> None:
        """Make sure, after `wait` s, that the actuator is gone, bring the chip to rest, and start another.

        One that was only late, or that this process was late for, is followed by one in its place.
        """
        now = clock.now()
        if self._child.link:
            self._node.membership.loop.unwatch(self._child.fileno())
        code = self._child.end(wait)
        why += signals.ending(code) if wait else ""  # it ended by itself, or somebody ended it
        self._rest()
        if self._never_stepped and code and code > 0:  # it has said why, in a sentence of its own
            self._exit_code = code
            self._node.stop()
            return
        self._standing = self._remember() if late or code == UNWATCHED else None
        self._restart_at = now + self._child.pause(now)
        self._why = f"the actuator is gone: {why}"
        self._node.log.error(f"{self._why}; the chip is kept at rest and another starts")
        self._tell_status()

    def _remember(self) -> Standing | None:
        """Return where the actuator stood, as far as another may go on from there."""
        standing = self._child.newest.standing if self._child.newest else self._standing
        return self._judge.correct(standing) if standing else None

    @property
    def _never_stepped(self) -> bool:
        """No actuator has ever reached the chip."""
        return self._child.starts == 1 and not self._child.ready

    def _keep_at_rest(self, now: float) -> None:
        """Write neutral until it is there and nobody else can write, then start another actuator."""
        gone = self._child.gone
        if not (self._hand.at_rest and gone):
            self._rest()
        elif self._restart_at is not None and now >= self._restart_at:
            self._start()

    def _rest(self) -> None:
        """Bring the chip to rest."""
        trouble = self._hand.rest(at_once=not self._never_stepped)
        if trouble and not self._never_stepped:
            self._node.log.error(f"cannot bring the chip to rest: {trouble}", "rest")

    def _finish(self) -> None:
        """Leave last, after neutral."""
        systemd.notify("STOPPING=1")
        self._child.ask_to_end()
        give_up = clock.now() + ENDS_WITHIN
        while not self._child.gone and clock.now() < give_up:
            time.sleep(STEP_EVERY)
            self._rest()  # it may hang in its end, with a chip that did not take its neutral
        self._child.end(0.0)
        give_up = clock.now() + (GRACE if self._never_stepped else RESTS_WITHIN)
        self._rest()
        while not self._hand.at_rest and clock.now() < give_up:
            time.sleep(STEP_EVERY)
            self._rest()
        self._say_last_word()
        self._hand.close()
        if self._recorder:
            self._recorder.end()

    def _say_last_word(self) -> None:
        robot = self._node.robot
        if self._hand.at_rest:
            self._why = f"ended, and {robot} is at rest: its chip reads neutral"
            if self._child.newest:  # which one that never stepped has not, and perhaps no chip either
                self._node.log.info(f"ends: {robot} is at rest, its chip reads neutral")
                self._tell_status(ended=True)
        elif not self._never_stepped:
            self._node.log.error(f"ends, and {robot} may move: neutral cannot be written; cut its power")

    def _tell(self) -> None:
        self._tell_status()
        if self._recorder and self._child.ready:
            self._recorder.tend(clock.now())

    def _tell_status(self, ended: bool = False) -> None:
        now = clock.now()
        self._statuses.publish(
            WatchdogStatus(
                state="ended" if ended else self._state,
                why=self._why,
                silence=max(0.0, self._child.silence(now)),
                moving=self._judge.moving if self._restart_at is None else not self._hand.at_rest,
                allowed=self._judge.allowed(now),
                commands=self._ears.commands % 2**32,
                restarts=self._child.starts - 1,
            )
        )

    @property
    def _state(self) -> Literal["starting", "watching", "resting"]:
        if self._restart_at is not None:
            return "resting"
        return "watching" if self._child.ready else "starting"
