"""Commands in, pulses out: the only process that moves the robot, under a watchdog that may end it."""

from zteleop.bus import clock
from zteleop.bus.loop import Timer
from zteleop.bus.node import Node
from zteleop.bus.subscription import Received
from zteleop.bus.topics import TOPICS
from zteleop.control.command import to_command
from zteleop.control.deadlines import STEADY_EVERY, STEP_EVERY
from zteleop.control.drive import Drive, Step
from zteleop.control.gate import Refusal
from zteleop.control.proof import NEVER, called
from zteleop.control.settings import DriveSettings
from zteleop.control.standing import NOBODY, Standing, go_on, stand
from zteleop.control.stop import stopped_by
from zteleop.drivers import PulseDriver
from zteleop.errors import MessageError
from zteleop.machine.health import LOOK_EVERY, Health
from zteleop.machine.ids import new_id
from zteleop.machine.limits_file import LimitsFile
from zteleop.machine.link import ActuatorEnd, Report
from zteleop.machine.stop_file import StopFile
from zteleop.messages import Message, Stop
from zteleop.nodes.limit_parameters import LimitParameters
from zteleop.nodes.output import Output, keeps_settings
from zteleop.nodes.state_publisher import StatePublisher
from zteleop.nodes.watched import UnwatchedError, Watched
from zteleop.recording.journal import Journal

AT_MOST_EVERY = 0.005
IN_A_ROW = 4
A_MOMENT = 0.001
"""s past a deadline; nothing is over before it has passed"""
CHECK_EVERY = 0.2
KEEP_EVERY = 1.0
AS_IT_IDLES = 0.5
"""s after an operator's deadline in which it is no news that what comes is refused"""
DEAF = "deaf"
UNHEARD = "the watchdog does not hear this robot on the bus"
TAKEN_OVER = "it stood still for a moment, and its actuator was started again"
FORGOT = "the chip has lost its settings, and the ESC perhaps its supply, while no actuator was there"


class Actuator:
    """Steps the drive on arrival, for latency, and on a clock, because only a clock hears silence."""

    def __init__(
        self,
        node: Node,
        settings: DriveSettings,
        driver: PulseDriver,
        link: ActuatorEnd,
        stop_file: StopFile,
        limits_file: LimitsFile,
        journal: Journal,
        health: Health | None = None,
        standing: Standing | None = None,
    ) -> None:
        self._node = node
        self._link = link
        self._stop_file = stop_file
        self._journal = journal
        now = self._since = clock.now()
        if standing and not keeps_settings(driver):
            self._tell_chip(f"{FORGOT}; whoever drove must let go first")
            standing = None
        self._drive = Drive(settings, driver.tick_us, standing.epoch if standing else new_id(), now)
        self._output = Output(driver, self._drive, self._tell_chip)
        # Whoever drove had an ESC that was armed, and the watchdog has kept the chip at neutral since.
        self._output.start(now, arm=standing is None or standing.source == NOBODY)
        self._state = StatePublisher(node, self._drive, driver.tick_us, self._output, stop_file)
        LimitParameters(node, self._drive, limits_file, lambda words: journal.event("limits", says=words))
        self._drive.admission.latch.released = stop_file.released()
        if standing:
            self._take_over(standing, now)
        else:
            self._drive.admission.hold(DEAF, "starting", UNHEARD, now)
        for stop in stop_file.load():
            self._drive.admission.stop(stop, NEVER)  # since when, nobody keeps
        self._step = self._drive.step(clock.now())
        self._answered = float("-inf")
        self._soon = node.membership.loop.alarm(self._answer)
        self._silence = node.membership.loop.alarm(self._advance)
        self._watched = Watched(node.membership.loop, self._notice_pause, clock.now())
        self._clock = self._keep_time(health)

    def run(self) -> None:
        """Drive until the node is stopped, then leave the chip at neutral."""
        why = ""
        try:
            for source in self._drive.settings.known_sources:
                for topic in ("cmd_vel", "pwm"):
                    self._node.subscription(f"{topic}/{source}", TOPICS[topic].types, self._receive)
            self._node.subscription("stop", Stop, lambda received: self._obey(received.message))
            self._node.membership.departures(self._withdraw)
            self._node.membership.loop.watch(self._link.fileno(), self._hear_watchdog)
            held, log = self._drive.admission.latch.stops, self._node.log
            more = f" once it is released: {stopped_by(held)}" if held else "; zteleop keyboard drives it"
            (log.warn if held else log.info)(f"{self._node.robot} obeys{more}")
            self._journal.event("start", robot=self._node.robot, epoch=self._drive.admission.gate.epoch)
            if why := self._drive.admission.interruption.why:
                self._node.log.warn(f"{why}; whoever drove goes on with the next act")
                self._journal.event("interruption", why=why)
            self._node.spin()
        except UnwatchedError as error:
            why = str(error)
            raise
        finally:
            self._finish(why)

    def _keep_time(self, health: Health | None) -> Timer:
        """Do each thing as often as it must be done; return what the steps go by."""
        steps = self._node.membership.loop.every(STEP_EVERY, self._tick)
        self._node.every(TOPICS["beat"].every)(lambda: self._state.tell(self._step))
        self._node.every(TOPICS["why"].every)(lambda: self._state.describe(self._step))
        self._node.every(CHECK_EVERY)(lambda: self._output.check(clock.now()))
        self._node.every(KEEP_EVERY)(self._stop_file.tend)
        if health:
            self._node.every(LOOK_EVERY)(lambda: self._drive.movement.cap.bear(health.look(clock.now())))
        return steps

    def _take_over(self, standing: Standing, now: float) -> None:
        """Go on in the place of an actuator that was ended for being late."""
        self._since = standing.since
        go_on(self._drive, standing, TAKEN_OVER, now)
        self._drive.admission.pause(DEAF, UNHEARD, now)

    def _finish(self, why: str) -> None:
        """Leave neutral behind, as far as the chip takes it, and say why where nobody is left to say it.

        First of all the watchdog is told that this is an end: leaving the bus may take longer than the
        silence after which it would start another in the place of one that was only late.
        """
        self._link.close()
        try:
            self._output.rest()
            if why:
                self._node.log.show = lambda line: None  # whoever is raised to prints it
                self._node.log.error(why)
        finally:
            self._output.close()
            self._journal.close()

    def _receive(self, received: Received[Message]) -> None:
        """Judge a command; when it counts, step at once, or as soon as the last answer is old enough.

        The pulses first: whatever is to be noted and told of it can wait for them.
        """
        now, source, proof = received.at, received.source, received.proof
        self._notice_pause(now)
        try:
            command = to_command(received.message)
        except MessageError as error:
            self._node.log.warn(f"{received.key}: dropped: {error}", received.key)
            return
        refusal = self._drive.receive(source, command, proof, now)
        moved = self._move() if refusal is None and self._may_answer(now) else None
        sender, acted = (proof.sender, proof.acted) if proof else (None, now)
        if proof:
            self._state.note(proof.sender, source, refusal, now)
        self._journal.command(source, sender, command, acted, refusal, now)
        if (
            refusal is Refusal.OPERATOR_IDLE
            and now - acted < self._drive.admission.operator_silence + AS_IT_IDLES
        ):
            return  # its sender goes neutral at the same moment
        if refusal:
            who = called(source, f"{proof.sender:x}") if proof else received.key
            self._node.log.warn(f"{who} is refused: {refusal}", f"{source} {refusal}")
        elif moved:
            self._state.time(received.came, now)
            self._report(*moved)
        else:
            self._step_soon(now)

    def _step_soon(self, now: float) -> None:
        """Step as soon as the last answer is old enough."""
        self._soon.ring_at(max(now, self._answered + AT_MOST_EVERY))

    def _answer(self) -> None:
        """Step for what has arrived."""
        if self._may_answer(clock.now()):
            self._advance()

    def _may_answer(self, now: float) -> bool:
        """Say whether to step now for what has arrived: 200 times a second, a few in a row at once."""
        due = self._answered + AT_MOST_EVERY
        if now < due:
            return False
        self._answered = max(due, now - (IN_A_ROW - 1) * AT_MOST_EVERY)
        return True

    def _tick(self) -> None:
        """Step by the clock, which alone hears that nobody speaks."""
        now = clock.now()
        self._notice_pause(now)
        self._output.tend(now)
        self._advance()

    def _advance(self) -> None:
        """Decide the pulses of now, write them, and report the step."""
        self._report(*self._move())

    def _move(self) -> tuple[Step, float]:
        """Decide the pulses of now and write them; return the step before, and when this one was."""
        now = clock.now()
        self._notice_pause(now)
        before, self._step = self._step, self._drive.step(now)
        self._output.write(self._step.pulse_us, now)
        return before, now

    def _report(self, before: Step, now: float) -> None:
        """Tell the watchdog of a step, and everybody of one that is news."""
        self._keep_pace(before, now)
        stopped = bool(self._drive.admission.latch.stops)
        self._link.report(Report(now, stand(self._drive, self._since), stopped))
        if (self._step.state, _driver(self._step)) != (before.state, _driver(before)):
            self._node.log.info(f"{self._step.state}: {self._step.why}")
            self._journal.event("state", state=self._step.state, why=self._step.why)
            # a beat as well: whoever begins now must prove that it was after this
            self._state.tell(self._step)
            self._state.describe(self._step)

    def _keep_pace(self, before: Step, now: float) -> None:
        """Step often while the pulses change, or do not arrive; else seldom, and when the claim ends."""
        is_steady = self._step.pulse_us == before.pulse_us and self._output.is_well
        self._clock.pace(STEADY_EVERY if is_steady else STEP_EVERY, now)
        if claim := self._step.claim:
            self._silence.ring_at(self._drive.admission.silences.end(claim) + A_MOMENT)

    def _notice_pause(self, now: float) -> None:
        """Notice that this process itself stood still: what it has heard, and not read, is from before.

        For a moment it is an interruption. Nobody watched the chip meanwhile, for a watchdog that could
        has ended this process by then: so a longer one is a start, with a new epoch.
        """
        if not (late := self._drive.admission.late(now)):
            return
        self._watched.since(now)
        words = f"this process stood still for {late:.2f} s"
        limit = self._drive.settings.deadlines.stand_still
        if late <= limit:
            self._node.log.warn(f"{words}; whoever drove goes on with the next act")
            self._drive.admission.interrupt(words, now, limit)
        else:
            self._node.log.warn(f"{words}; whoever drove must let go first")
            self._drive.admission.restart(new_id(), now)
            self._since = now
        self._journal.event("interruption", why=words)

    def _hear_watchdog(self) -> None:
        words = self._link.read()
        now = clock.now()
        self._watched.since(now)
        if words.hears is not None:
            self._output.is_cut = words.cut
        for stop in words.stops:
            self._obey(stop)
        if words.hears:
            self._drive.admission.resume(DEAF, "the watchdog did not hear this robot on the bus", now)
        elif words.hears is False:
            self._drive.admission.pause(DEAF, UNHEARD, now)

    def _obey(self, said: Stop) -> None:
        """Obey a stop or a release; the pulses first, the file and the words afterwards."""
        latch = self._drive.admission.latch
        rest = latch.without(said.id)
        releases = not said.engaged and len(rest) < len(latch.stops)
        if releases and not self._stop_file.release(said, rest):
            return
        if not self._drive.admission.stop(said, clock.now()):
            return
        if said.engaged:
            self._stop_file.promise(latch.stops)
        self._advance()
        self._output.confirm()
        self._stop_file.tend()
        self._state.tell_status(self._step)  # whoever pressed waits for what the chip and the disk said
        self._journal.event("stop" if said.engaged else "release", by=said.by, why=said.why, id=said.id)

    def _tell_chip(self, words: str) -> None:
        self._node.log.warn(words)
        self._journal.event("chip", says=words)

    def _withdraw(self, sender: int) -> None:
        """Let go at once for a sender whose process is gone; its deadline would come later."""
        now = clock.now()
        self._drive.admission.withdraw(sender, now)
        self._step_soon(now)  # strangers may come and go by the thousand


def _driver(step: Step) -> int | None:
    return step.claim.sender if step.claim else None
