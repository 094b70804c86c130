"""A robot, its watchdog's judge and several senders, on a network that does what it likes.

What may move the robot is kept here a second time, from what really happened and not from what the
drive remembers: see `Truth`.
"""

from collections import deque
from collections.abc import Callable
from heapq import heappop, heappush
from random import Random
from typing import NamedTuple

from zteleop.control.drive import Drive, Step
from zteleop.control.judge import Judge
from zteleop.control.limiter import Limits
from zteleop.control.mux import Source
from zteleop.control.proof import NEVER, Proof, Prover
from zteleop.control.settings import DriveSettings
from zteleop.control.standing import go_on, stand
from zteleop.messages import Beat, Pwm, State, Stop, Twist

TICK_US = 4.08
NEUTRAL = {0: 1509.6, 1: 1530.0}
COMMANDS = (Twist.planar(0.5), Twist.planar(-0.3, 0.4), Twist.planar(0.0, 1.0), Pwm(390, 400), Pwm(350, 370))
RESTS = (Twist.planar(), Pwm(375, 370))
SETTINGS = DriveSettings(
    limits=Limits(acceleration=1000.0), sources={"nav": Source(10, silence=0.5, trust="arrival")}
)
SILENCE = {"keyboard": 0.3, "gamepad": 0.3, "web": 0.3, "program": 0.5, "nav": 0.5}
SENDERS = ("keyboard", "keyboard", "web", "gamepad", "program")
MAX_AGE, OPERATOR, LINK_LOSS, LATE, STAND_STILL = 0.3, 5.0, 2.0, 0.2, 0.5
JUDGE_HEARS, JUDGE_LOOKS = 0.02, 0.05
PRIORITY: tuple[State, ...] = ("fault", "stopped", "starting", "link lost")


class Told(NamedTuple):
    """A command, and what is true of it by the robot's clock."""

    source: str
    sender: int
    number: int
    command: Twist | Pwm
    moving: bool
    proof: Proof | None
    epoch: int
    beat: float
    acted: float
    began: float


class Heard(NamedTuple):
    number: int
    moving: bool
    at: float


class Truth:
    """What may move the robot, from what really happened."""

    def __init__(self, epoch: int, now: float) -> None:
        self.heard: dict[int, Heard] = {}
        self.claims: dict[int, tuple[Told, float]] = {}
        self.lost: dict[int, float] = {}
        self.dead: set[tuple[int, float]] = set()
        """Claims that began and were not heard, or did not count, for too long."""
        self.counted: dict[tuple[int, float], float] = {}
        """When a command of each claim last counted, or lacked nothing but an act."""
        self.rights: set[tuple[int, float]] = set()
        """Claims that an interruption left their right to go on."""
        self.again: dict[tuple[int, float], float] = {}
        """When each claim was heard again after its sender had fallen silent."""
        self.holds: dict[str, State] = {}
        self.start(epoch, now)

    def start(self, epoch: int, now: float) -> None:
        self.epoch, self.since, self.floor = epoch, now, now
        self.interrupted = NEVER
        self.heard.clear()
        self.counted.clear()
        self.rights.clear()
        self.again.clear()
        self.claims.clear()
        self.lost.clear()
        self.dead.clear()

    def hold(self, reason: str, state: State) -> None:
        self.holds[reason] = state
        self.claims.clear()

    def free(self, reason: str, now: float) -> None:
        if self.holds.pop(reason, None):
            self.floor = now

    def release_unheard(self, now: float) -> None:
        """A stop that nobody here knew of is over: whoever drives begins anew."""
        self.floor = now
        self.claims.clear()

    def relieve(self, driver: int, now: float) -> None:
        """Another drive takes the place of one that was late, and knows only who drove last."""
        self.holds.clear()
        self.claims = {sender: claim for sender, claim in self.claims.items() if sender == driver}
        self.heard = {sender: heard for sender, heard in self.heard.items() if sender == driver}
        self.interrupt(now, LINK_LOSS)

    def interrupt(self, now: float, limit: float) -> None:
        self.interrupted = now
        self.rights = {claim for claim, at in self.counted.items() if now - at <= limit}

    def hear(self, told: Told, now: float) -> None:
        """Note a command that arrived in time, in order, and from this start."""
        if told.epoch != self.epoch or not 0 <= now - told.beat <= MAX_AGE:
            return
        last = self.heard.get(told.sender)
        if last and told.number <= last.number:
            return
        if last and last.moving and now - last.at > LINK_LOSS:
            self.lost[told.sender] = min(last.at + LINK_LOSS, now - MAX_AGE)
        if told.moving and now - max(told.began, last.at if last and last.moving else NEVER) > LINK_LOSS:
            self.dead.add((told.sender, told.began))
        claim = (told.sender, told.began)
        if now - self.counted.get(claim, now) > LINK_LOSS:
            self.dead.add(claim)
        if last and last.moving and told.began <= last.at < now - SILENCE[told.source]:
            self.again[claim] = now
        self.heard[told.sender] = Heard(told.number, told.moving, now)
        self.claims.pop(told.sender, None)
        if told.moving:
            self.claims[told.sender] = (told, now)
            if not self.holds and self._may_begin(told):
                self.counted[claim] = now

    def may_move(self, now: float) -> bool:
        return not self.holds and any(self._counts(*claim, now) for claim in self.claims.values())

    def _counts(self, told: Told, at: float, now: float) -> bool:
        return (
            now - at <= SILENCE[told.source]
            and now - told.acted <= OPERATOR
            and self._may_begin(told)
            and min(told.beat, told.acted)
            > max(self.interrupted, self.again.get((told.sender, told.began), NEVER))
        )

    def _may_begin(self, told: Told) -> bool:
        claim = (told.sender, told.began)
        after = self.floor if claim in self.rights else max(self.floor, self.interrupted)
        return told.began > max(after, self.lost.get(told.sender, NEVER)) and claim not in self.dead

    @property
    def state(self) -> State | None:
        return min(self.holds.values(), key=PRIORITY.index, default=None)


class Sender:
    """Somebody who drives; an honest one, with a clock of its own and a link of its own."""

    def __init__(self, source: str, identity: int, clock: float) -> None:
        self.source, self.identity, self.clock = source, identity, clock
        self.silence = float("inf") if source == "gamepad" else 0.5
        self.prover = Prover(identity, self.silence)
        self.beat: Beat | None = None
        self.hears, self.speaks, self.delay = True, True, 0.0
        self.number = 0
        self.command: Twist | Pwm | None = None
        self.acts = True
        self.frozen = False
        self.period = 0.045
        self.said = NEVER
        self._acted = self._began = NEVER
        self._epoch = -1
        self._moved, self._then = False, NEVER

    def hear(self, epoch: int, time: float, floor: float) -> None:
        if self.hears and not (self.beat and self.beat.epoch == epoch and self.beat.time >= time):
            self.beat = Beat(epoch, time, floor)

    def say(self, command: Twist | Pwm, moving: bool, act: bool, now: float) -> Told:
        if act:
            self.prover.act(self.beat)
            self._acted = now
        then = now + self.clock
        is_over = self.beat is None or self.beat.epoch != self._epoch or self._began <= self.beat.floor
        if moving and (not self._moved or then - self._then > max(self.silence, LINK_LOSS * is_over)):
            self._began = self._acted
            self._epoch = self.beat.epoch if self.beat else -1
        self._moved, self._then = moving, then
        self.number += 1
        proof = self.prover.prove(self.beat, moving, then)
        epoch, beat = (self.beat.epoch, self.beat.time) if self.beat else (-1, NEVER)
        return Told(
            self.source,
            self.identity,
            self.number,
            command,
            moving,
            proof,
            epoch,
            beat,
            self._acted,
            self._began,
        )


Sabotage = Callable[[Drive], None]


class World:
    """Everything above, one act at a time; each act ends in a step of the drive, and is judged."""

    def __init__(self, random: Random, sabotage: Sabotage | None = None) -> None:
        self.random, self.sabotage = random, sabotage
        self.now, self.epoch = 100.0, 0
        self.visited: dict[str, int] = {}
        self.steps = self.moved = self.refused = 0
        self.pressed = self.obeyed = 0
        """Fresh presses from neutral that nothing stood against, and how many of them drove."""
        self.interrupted = self.came_back = 0
        """Short interruptions of somebody who acts all along, and after how many of them it drove on."""
        self.trail: deque[tuple[float, str, object]] = deque(maxlen=60)
        self.wire: list[tuple[float, int, Told]] = []
        self.ear: list[tuple[float, int, Told]] = []
        self.held_back: list[Told] = []
        self.recent: deque[Told] = deque(maxlen=12)
        self.stops: deque[int] = deque(maxlen=5)
        self.in_force: dict[str, Stop] = {}
        """The newest stop of each presser that nobody has released"""
        self.away = False
        """No drive steps: one was ended for being late, and another is about to take its place."""
        self.unsafe: str | None = None
        self.alarm: str | None = None
        self._identity = self._count = 0
        self._stepped = self._looked = self._polled = self.now
        self._due: dict[int, float] = {}
        self._foreign = (self.now, True, NEVER)
        self.boot()
        self.senders = [self._sender(source) for source in SENDERS]

    # the robot

    def boot(self) -> None:
        """Start the robot's actuator and watchdog; a stop outlives both."""
        self.judge = Judge(SETTINGS, TICK_US, self.now)
        self.truth = Truth(self.epoch, self.now)
        self.ear.clear()
        self._due.clear()
        self._looked = self._polled = self.now
        self.start_actuator()

    def start_actuator(self) -> None:
        self.epoch += 1
        self._stepped = self.now
        self.drive = Drive(SETTINGS, TICK_US, self.epoch, self.now)
        if self.sabotage:
            self.sabotage(self.drive)
        self._foreign = (self.now, True, NEVER)
        self.truth.holds.clear()
        self.truth.start(self.epoch, self.now)
        self._keep_stop()
        self.judge.hear_report(stand(self.drive, self.truth.since))

    def _keep_stop(self) -> None:
        """Let a new drive know of the stops that are kept, and of no other."""
        self.stops.clear()
        for stop in self.in_force.values():
            self.drive.admission.stop(stop, self.now)
            self.stops.append(stop.id)
            self.truth.hold("stop", "stopped")

    def take_over(self) -> None:
        """Let another drive take the place of this one, which was ended for being late."""
        standing = stand(self.drive, self.truth.since)
        standing = standing._replace(floor=max(standing.floor, self.judge.released))
        self._stepped = self.now
        self.drive = Drive(SETTINGS, TICK_US, self.epoch, self.now)
        if self.sabotage:
            self.sabotage(self.drive)
        go_on(self.drive, standing, "", self.now)
        self._foreign = (self.now, True, standing.began if standing.sender < 0 else NEVER)
        self.truth.relieve(max(standing.sender, 0), self.now)
        self._keep_stop()
        self.judge.hear_report(stand(self.drive, self.truth.since))

    def reboot(self, back: float) -> None:
        """Reboot; the robot's clock begins again, at a time that has been before."""
        self.now -= back
        self.wire = [(due - back, count, told) for due, count, told in self.wire]
        for sender in self.senders:
            sender.clock += back
        self.boot()

    def pass_by(self, seconds: float) -> None:
        self.now += seconds
        wire = self.wire
        while wire and wire[0][0] <= self.now:
            self._arrive(heappop(wire)[2])

    def step(self) -> Step:
        """Step, and hold what the robot does against what it may."""
        self._notice_pause()
        step = self.drive.step(self.now)
        self.steps += 1
        self.visited[step.state] = self.visited.get(step.state, 0) + 1
        moves = step.pulse_us != NEUTRAL
        if moves:
            self.moved += 1
            if not self.truth.may_move(self.now):
                self._blame(f"it moves: {step.state}, {step.why}")
        if (held := self.truth.state) and step.state != held:
            self._blame(f"it should be {held}, and is {step.state}")
        self._let_judge_look(step)
        return step

    def _blame(self, what: str) -> None:
        self.unsafe = self.unsafe or f"at {self.now:.3f} {what}"

    def _notice_pause(self) -> None:
        stood_still = self.now - self._stepped
        if stood_still > STAND_STILL:
            self.truth.start(self.epoch + 1, self.now)
            self._foreign = (self.now, True, NEVER)
        elif stood_still > LATE:
            self.truth.interrupt(self.now, STAND_STILL)
        if (late := self.drive.admission.late(self.now)) > STAND_STILL:
            self.epoch += 1
            self.drive.admission.restart(self.epoch, self.now)
            self.judge.hear_report(stand(self.drive, self.truth.since))
        elif late:
            self.drive.admission.interrupt("it stood still", self.now, STAND_STILL)
        self._stepped = self.now

    def _arrive(self, told: Told) -> None:
        if not self.away:
            self._arrive_at_drive(told)
        self._count += 1
        due = max(self.now + self.random.random() * JUDGE_HEARS, self._due.get(told.sender, NEVER))
        self._due[told.sender] = due  # what one sender says stays in order
        heappush(self.ear, (due, self._count, told))

    def _arrive_at_drive(self, told: Told) -> None:
        self._notice_pause()
        if told.proof is None and told.source == "nav":
            told = self._found(told)
        self.truth.hear(told, self.now)
        if self.drive.receive(told.source, told.command, told.proof, self.now):
            self.refused += 1

    def _found(self, told: Told) -> Told:
        """Return a command of a foreign sender as what its arrival makes it."""
        then, moved, began = self._foreign
        pause = LINK_LOSS if began <= self.truth.floor else 0.5
        begins = told.moving and (not moved or self.now - then > pause)
        began = self.now if begins else began
        if not begins or self.now - self.truth.interrupted > MAX_AGE:  # what may be old begins nothing
            self._foreign = (self.now, told.moving, began)
        return told._replace(epoch=self.truth.epoch, beat=self.now, acted=self.now, began=began)

    def _let_judge_look(self, step: Step) -> None:
        ear, now = self.ear, self.now
        while ear and ear[0][0] <= now:
            due, _, told = heappop(ear)
            self.judge.receive(told.source, told.command, told.proof, due)
        if now - self._polled >= JUDGE_HEARS:
            self._polled = now
            self.judge.rest(bool(self.in_force), now)
        if now - self._looked >= JUDGE_LOOKS:
            self._looked = now
            if why := self.judge.look(step.pulse_us, now):
                self.alarm = self.alarm or f"at {now:.3f} {why}"

    # its senders

    def _sender(self, source: str) -> Sender:
        self._identity += 1
        sender = Sender(source, self._identity, self.random.uniform(-1e6, 1e6))
        sender.hear(self.epoch, self.now, self.truth.floor)
        return sender

    def say(self, sender: Sender, command: Twist | Pwm | None, act: bool) -> None:
        """Send a command, or a neutral one; how it travels is the link's affair."""
        heard = max(self.now - self.random.random() * 0.06, self.truth.since)
        sender.hear(self.epoch, heard, min(self.truth.floor, heard))
        sender.said = self.now
        moving = command is not None
        told = sender.say(command or self.random.choice(RESTS), moving, act, self.now)
        self.recent.append(told)
        if not sender.speaks:
            self.held_back.append(told)
        elif sender.delay:
            self._count += 1
            heappush(self.wire, (self.now + sender.delay, self._count, told))
        else:
            self._arrive(told)

    # what happens; each act has one argument

    def do(self, name: str, argument: object) -> Step:
        self.trail.append((self.now, name, argument))
        getattr(self, f"_{name}")(argument)
        return self.step()

    def _carry_on(self, seconds: float) -> None:
        """Let time pass, and let everybody who holds something say so, most of them 20 times a second."""
        self.pass_by(seconds)
        for sender in self.senders:
            if sender.command and not sender.frozen and self.now - sender.said >= sender.period:
                self.say(sender, sender.command, sender.acts)

    def _pause(self, seconds: float) -> None:
        """The robot itself does nothing for a while; hours are a suspend."""
        self.pass_by(seconds)

    def _press(self, who: int) -> None:
        sender = self.senders[who]
        fresh = sender.command is None and sender.speaks and not sender.delay
        sender.command, sender.frozen = self.random.choice(COMMANDS), False
        self.say(sender, sender.command, act=True)
        if fresh and self._must_drive(sender):
            self.pressed += 1
            self.obeyed += self.drive.step(self.now).state == "driving"

    def _must_drive(self, sender: Sender) -> bool:
        """Say whether nothing stands against a claim that has just begun and was heard at once."""
        truth, beat = self.truth, sender.beat
        others = [told for told, _ in truth.claims.values() if told.sender != sender.identity]
        return (
            not truth.holds
            and beat is not None
            and beat.epoch == truth.epoch
            and beat.time > max(truth.floor, truth.interrupted, truth.lost.get(sender.identity, NEVER))
            and self.now - beat.time <= MAX_AGE
            and all(told.source != sender.source for told in others)
        )

    def _act(self, who: int) -> None:
        """Whoever holds something acts once more; or acts no more, and it is only said again."""
        sender = self.senders[who]
        sender.acts = not sender.acts
        if sender.command:
            self.say(sender, sender.command, sender.acts)

    def _let_go(self, who: int) -> None:
        self.senders[who].command = None
        self.say(self.senders[who], None, act=False)

    def _freeze(self, who: int) -> None:
        """Say nothing more, or go on where it was left."""
        self.senders[who].frozen = not self.senders[who].frozen

    def _slow(self, who: int) -> None:
        """Say what is held less often than a program may pause; or as often as everybody."""
        sender = self.senders[who]
        sender.period = 0.045 if sender.period > 0.5 else 0.8

    def _leave(self, who: int) -> None:
        """Its process is gone; another may come in its place."""
        sender = self.senders[who]
        self.drive.admission.withdraw(sender.identity, self.now)
        self.truth.claims.pop(sender.identity, None)
        if self.random.random() < 0.5:
            self.senders[who] = self._sender(sender.source)

    def _cut(self, who: int) -> None:
        """Cut its link; or mend it, and what was said meanwhile is lost, or comes at once."""
        sender = self.senders[who]
        sender.speaks = not sender.speaks
        if sender.speaks and self.random.random() < 0.5:
            for told in self.held_back[-20:]:
                self._arrive(told)
        self.held_back.clear()

    def _deafen(self, who: int) -> None:
        self.senders[who].hears = not self.senders[who].hears

    def _delay(self, seconds: float) -> None:
        self.random.choice(self.senders).delay = seconds

    def _jump(self, seconds: float) -> None:
        self.random.choice(self.senders).clock += seconds

    def _replay(self, back: int) -> None:
        if self.recent:
            self._arrive(self.recent[-1 - back % len(self.recent)])

    def _reorder(self, within: float) -> None:
        """Let everything under way arrive in another order."""
        self.wire = [(self.now + self.random.random() * within, *rest) for _, *rest in self.wire[:20]]
        self.wire.sort()

    def _nav(self, moving: bool) -> None:
        command = COMMANDS[0] if moving else RESTS[0]
        self._arrive(Told("nav", 0, self._count, command, moving, None, 0, 0.0, 0.0, 0.0))

    def _stop(self, kind: str) -> None:
        """Press a stop; or an old one is heard again, late."""
        if kind == "old" and not self.stops:
            return
        known = kind == "old"
        identity = self.random.choice(self.stops) if known else self.random.getrandbits(53)
        said = Stop(engaged=True, id=identity, by=self.random.choice(("ann", "bob")), why="")
        self.drive.admission.stop(said, self.now)
        if not known:
            self.stops.append(identity)
            self.in_force[said.by] = said
            self.truth.hold("stop", "stopped")

    def _release(self, kind: str) -> None:
        """Release a stop in force, or an older one, or one that never was."""
        in_force = list(self.in_force.values())
        if kind == "right" and not in_force:
            return
        identity = self.random.choice(in_force).id if in_force else self.random.getrandbits(53)
        if kind == "stale" and self.stops:
            identity = self.stops[0]
        elif kind == "wrong":
            identity = self.random.getrandbits(53)
        self.drive.admission.stop(Stop(engaged=False, id=identity, by="", why=""), self.now)
        self.in_force = {by: stop for by, stop in self.in_force.items() if stop.id != identity}
        if in_force and not self.in_force:
            self.truth.free("stop", self.now)
        elif not in_force and identity not in self.stops:
            self.truth.release_unheard(self.now)

    def _fault(self, on: bool) -> None:
        self._rest("chip", "fault", on)

    def _arm(self, on: bool) -> None:
        self._rest("esc", "starting", on)

    def _rest(self, reason: str, state: State, on: bool) -> None:
        if on:
            self.drive.admission.hold(reason, state, "", self.now)
            self.truth.hold(reason, state)
        else:
            self.drive.admission.free(reason, self.now)
            self.truth.free(reason, self.now)

    def _deaf(self, on: bool) -> None:
        """The watchdog hears the robot on the bus, or does not."""
        if on:
            self.drive.admission.pause("deaf", "", self.now)
            self.truth.holds["deaf"] = "link lost"
        else:
            self.drive.admission.resume("deaf", "it was deaf", self.now)
            if self.truth.holds.pop("deaf", None):
                self.truth.interrupt(self.now, LINK_LOSS)

    def _relieve(self, seconds: float) -> None:
        """Its watchdog ends the drive for being late; some time later another takes its place."""
        self.away = True
        end = self.now + seconds
        while self.now < end:
            self._carry_on(0.06)
        self.away = False
        self.take_over()

    def _come_and_go(self, _: object) -> None:
        """A stop comes and goes while no drive steps: only the watchdog has heard of it."""
        self.judge.hear_release(self.now)
        self.truth.floor = self.now
        self._relieve(0.3)

    def _restart(self, _: object) -> None:
        self.start_actuator()

    def _reboot(self, back: float) -> None:
        self.reboot(back)


WHO = tuple(range(len(SENDERS)))
ON = (True, False)
ACTS: dict[str, tuple[float, tuple[object, ...]]] = {
    "carry_on": (60, (0.004, 0.01, 0.02, 0.05, 0.06, 0.1, 0.19)),
    "press": (12, WHO),
    "let_go": (9, WHO),
    "act": (3, WHO),
    "freeze": (3, WHO),
    "slow": (1, WHO),
    "leave": (1, WHO),
    "cut": (2, WHO),
    "deafen": (2, WHO),
    "delay": (2, (0.0, 0.0, 0.02, 0.05, 0.1, 0.25, 0.35, 2.5)),
    "jump": (1, (0.1, 0.6, 3600.0, -0.1, -3600.0)),
    "replay": (5, tuple(range(12))),
    "reorder": (2, (0.01, 0.1, 0.3)),
    "nav": (2, (True, True, False)),
    "stop": (0.8, ("new", "old", "old")),
    "release": (3, ("right", "right", "right", "right", "stale", "wrong")),
    "fault": (0.8, (True, False, False)),
    "arm": (0.8, (True, False, False)),
    "deaf": (0.2, (True, False, False)),
    "pause": (0.4, (0.15, 0.21, 0.3, 0.45, 0.55, 3.0, 4 * 3600.0)),
    "relieve": (0.3, (0.3, 0.9, 1.7, 2.3)),
    "come_and_go": (0.2, (None,)),
    "restart": (0.3, (None,)),
    "reboot": (0.3, (0.05, 0.3, 0.6)),
}
"""How often each is done in a walk, and with which arguments."""


def walk(world: World, steps: int) -> None:
    """Do anything in any order, and sometimes nothing but let time pass; end where something is wrong."""
    random = world.random
    names, weights = list(ACTS), [weight for weight, _ in ACTS.values()]
    while world.steps < steps:
        for name in random.choices(names, weights, k=100):
            world.do(name, random.choice(ACTS[name][1]))
        if random.random() < 0.5:
            _drive_well(world)
        if random.random() < 0.1:
            _keep_still(world)
        if random.random() < 0.15:
            _come_back(world)
        if random.random() < 0.15:
            _be_away_for_long(world)


def _drive_well(world: World) -> int:
    """Let somebody drive with nothing in the way; the walk itself seldom lets it be for long. Return who."""
    who = world.random.choice(WHO)
    sender = world.senders[who]
    sender.speaks, sender.hears, sender.delay, sender.acts = True, True, 0.0, True
    sender.period = 0.045
    freed = (("release", "right"), ("fault", False), ("arm", False), ("deaf", False), ("carry_on", 0.06))
    for name, argument in freed:
        world.do(name, argument)
    for name in ("let_go", "press"):
        world.do(name, who)
        world.do("carry_on", 0.06)
    return who


INTERRUPTIONS = (
    ("pause", 0.25),
    ("pause", 0.4),
    ("deaf", 0.7),
    ("deaf", 1.7),
    ("relieve", 0.6),
    ("relieve", 1.6),
)


def _come_back(world: World) -> None:
    """Interrupt somebody who drives and acts all along, for a moment; nothing else happens meanwhile."""
    who = _drive_well(world)
    state, driver = world.do("carry_on", 0.06).state, world.drive.admission.driver
    if state != "driving" or not driver or driver.sender != world.senders[who].identity:
        return
    kind, seconds = world.random.choice(INTERRUPTIONS)
    if kind != "deaf":
        world.do(kind, seconds)
    else:
        world.do("deaf", True)
        _go_on(world, seconds)
        world.do("deaf", False)
    states = [world.do("carry_on", 0.06).state for _ in range(4)]
    world.interrupted += 1
    world.came_back += "driving" in states


def _be_away_for_long(world: World) -> None:
    """Interrupt somebody who acts all along for longer than a claim may go on; then it must not."""
    who = _drive_well(world)
    kind = world.random.choice(("cut", "deaf", "relieve", "freeze and pause"))
    if kind == "relieve":
        world.do("relieve", 2.1)
    elif kind == "freeze and pause":  # each for less than its limit, and together for more
        world.do("freeze", who)
        _go_on(world, 0.4)
        world.do("pause", 0.3)
        world.do("freeze", who)
    else:
        on, off = (who, who) if kind == "cut" else (True, False)
        world.do(kind, on)
        _go_on(world, 2.6)
        world.do(kind, off)
    _go_on(world, 0.3)


def _go_on(world: World, seconds: float) -> None:
    while seconds > 0:
        seconds -= 0.06
        world.do("carry_on", 0.06)


def _keep_still(world: World) -> None:
    """Let nobody act, so that every deadline passes."""
    quiet = world.random.choice((0.35, 2.2, 2.6, 5.4))
    for sender in world.senders:
        sender.acts = False
    while quiet > 0:
        quiet -= 0.1
        world.do("carry_on", 0.1)
