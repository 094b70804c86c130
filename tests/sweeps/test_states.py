"""The seven states: a table of every transition, a long random walk, any acts at all, and defects on purpose.

What is asserted of any sequence of commands, acts, stops, silences, delays and restarts: no motion
without a fresh acting claim, and no motion after a stop, a long link loss, a fault, an arming pause or
a start until a claim that left neutral afterwards. `world.Truth` says what that is.
"""

import os
from collections.abc import Callable
from functools import partial
from math import ceil
from random import Random

import pytest
from hypothesis import Phase, find, given, settings
from hypothesis import strategies as st
from unit.control.robot import FORWARD, REST, Robot, moves
from unit.control.world import ACTS, Sabotage, World, walk

from zteleop.control.drive import Drive
from zteleop.control.gate import Gate, Refusal
from zteleop.control.limiter import Limits
from zteleop.control.proof import NEVER, Proof
from zteleop.control.settings import DriveSettings
from zteleop.messages import State, Stop

# A table of every state and what each event makes of it.


def press(robot: Robot) -> None:
    robot.say(REST)
    robot.wait(0.02)
    robot.say(FORWARD)


def fall_silent(robot: Robot) -> None:
    robot.wait(0.4)


def act_no_more(robot: Robot) -> None:
    robot.hold(FORWARD, 5.2, act=False)


def pause(robot: Robot) -> None:
    """Stop the robot's own process for longer than a claim may outlive."""
    robot.now += 0.6
    assert robot.drive.admission.late(robot.now)
    robot.epoch += 1
    robot.drive.admission.restart(robot.epoch, robot.now)


def hiccup(robot: Robot) -> None:
    """Stop the robot's own process for a moment."""
    robot.now += 0.3
    assert robot.drive.admission.late(robot.now)
    robot.drive.admission.interrupt("it stood still", robot.now, 0.5)


def act_again(robot: Robot) -> None:
    for _ in range(2):  # the first tells the robot that it is heard again
        robot.say(FORWARD)
        robot.wait(0.02)


def hold(state: State, robot: Robot) -> None:
    robot.drive.admission.hold(state, state, f"{state} for a reason", robot.now)


def free(state: State, robot: Robot) -> None:
    robot.drive.admission.free(state, robot.now)


EVENTS: dict[str, Callable[[Robot], object]] = {
    "press": press,
    "act again": act_again,
    "hiccup": hiccup,
    "say again": lambda robot: robot.say(FORWARD, act=False),
    "let go": lambda robot: robot.say(REST),
    "silence": fall_silent,
    "act no more": act_no_more,
    "depart": lambda robot: robot.drive.admission.withdraw(1, robot.now),
    "stop": lambda robot: robot.stop(7),
    "release": lambda robot: robot.release(7),
    "release another": lambda robot: robot.release(8),
    "fail": partial(hold, "fault"),
    "recover": partial(free, "fault"),
    "arm": partial(hold, "starting"),
    "armed": partial(free, "starting"),
    "pause": pause,
}
REACHED: dict[State, list[str]] = {
    "idle": [],
    "driving": ["press"],
    "link lost": ["press", "silence"],
    "operator idle": ["press", "act no more"],
    "starting": ["press", "arm"],
    "fault": ["press", "fail"],
    "stopped": ["press", "stop"],
}
STATES: tuple[State, ...] = tuple(REACHED)
SAME = dict.fromkeys(EVENTS)
CALLED: dict[str, State] = {"stop": "stopped", "fail": "fault", "arm": "starting", "pause": "idle"}
ANEW: dict[str, State] = {"release": "idle", "release another": "idle"}
"""The end of a stop that was never heard is the end of all claims as well."""
AGAIN: dict[str, State] = {"press": "driving", "act again": "driving"}
TABLE: dict[State, dict[str, State | None]] = {
    "idle": SAME | CALLED | AGAIN | {"say again": None, "act no more": "link lost"},
    "driving": SAME
    | CALLED
    | ANEW
    | {
        "let go": "idle",
        "silence": "link lost",
        "hiccup": "link lost",
        "act no more": "operator idle",
        "depart": "link lost",
    },
    "link lost": SAME | CALLED | AGAIN | ANEW | {"let go": "idle", "act no more": "idle"},  # which takes 5 s
    "operator idle": SAME | CALLED | AGAIN | ANEW | {"let go": "idle", "depart": "link lost"},
    "starting": SAME | CALLED | {"armed": "idle", "pause": None},
    "fault": SAME | {"recover": "idle"},
    "stopped": SAME | {"release": "idle", "fail": "fault"},
}
"""What follows on each event; None is no change."""
del TABLE["idle"]["act no more"]  # a key that was never pressed cannot be held


@pytest.mark.parametrize(("state", "event"), [(state, event) for state in STATES for event in TABLE[state]])
def test_every_transition(state: State, event: str) -> None:
    robot = Robot(DriveSettings(limits=Limits(acceleration=1000.0)))
    for name in REACHED[state]:
        EVENTS[name](robot)
        robot.wait(0.02)
    assert robot.step().state == state
    EVENTS[event](robot)
    step = robot.wait(0.02)
    assert step.state == (TABLE[state][event] or state)
    assert moves(step) == (step.state == "driving")


def test_every_state_is_entered_and_left_in_the_table() -> None:
    entered = {after for row in TABLE.values() for after in row.values() if after}
    left = {
        state for state, row in TABLE.items() if any(after not in (None, state) for after in row.values())
    }
    assert entered == left == set(STATES) == set(State.__args__)


@pytest.mark.parametrize("event", ["stop", "fail", "arm", "pause"])
def test_after_what_brought_it_to_rest_only_a_new_press_drives(event: str) -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.2)
    EVENTS[event](robot)
    robot.hold(FORWARD, 0.5)
    for name in ("release", "recover", "armed"):
        EVENTS[name](robot)
    assert not moves(robot.hold(FORWARD, 1.0))
    press(robot)
    assert moves(robot.hold(FORWARD, 0.2))


# Anything in any order.

STEPS = int(os.environ.get("ZTELEOP_STEPS", "20_000"))
"""`make soak` walks further"""
VISITED_AT_LEAST = {"idle": 1 / 20, "operator idle": 1 / 2000} | dict.fromkeys(
    ("driving", "link lost", "stopped", "fault", "starting"), 1 / 40
)
"""of the steps"""


def test_a_long_walk_never_moves_what_may_not_move(record_property: Callable[[str, object], None]) -> None:
    world = World(Random(1))
    walk(world, STEPS)
    for state in STATES:
        record_property(state, world.visited.get(state, 0))
    assert (world.unsafe, world.alarm) == (None, None), list(world.trail)
    assert {
        state for state in STATES if world.visited.get(state, 0) < STEPS * VISITED_AT_LEAST[state]
    } == set()
    assert world.moved > STEPS / 10
    assert world.pressed > STEPS / 200
    assert world.obeyed == world.pressed, "a fresh press from neutral drives"
    assert world.interrupted > STEPS / 2000
    assert world.came_back == world.interrupted, "whoever was interrupted for a moment drives on"


OFTEN = [name for name, (weight, _) in ACTS.items() for _ in range(ceil(weight**0.5))]
acts = st.lists(st.tuples(st.sampled_from(OFTEN), st.integers(0, 11)), min_size=20, max_size=100)


def do(world: World, done: list[tuple[str, int]]) -> None:
    for name, number in done:
        choices = ACTS[name][1]
        world.do(name, choices[number % len(choices)])
        assert (world.unsafe, world.alarm) == (None, None)


@given(acts)
def test_no_acts_move_what_may_not_move(done: list[tuple[str, int]]) -> None:
    do(World(Random(1)), done)


def test_a_defect_is_found_among_any_acts() -> None:
    def unsafe(done: list[tuple[str, int]]) -> bool:
        try:
            do(World(Random(1), free_without_a_floor), done)
        except AssertionError:
            return True
        return False

    first = settings(max_examples=3000, database=None, phases=[Phase.generate])
    assert find(acts, unsafe, settings=first, random=Random(1))


# Defects on purpose: the walk would not be worth its time if it did not find them.


def lenient(*refusals: Refusal, drive: Drive) -> None:
    """Let pass what the gate refuses for these reasons."""
    judge = drive.admission.gate.judge

    def pass_by(proof: Proof | None, moving: bool, now: float, silence: float) -> Refusal | None:
        refusal = judge(proof, moving, now, silence)
        return None if refusal in refusals else refusal

    drive.admission.gate.judge = pass_by


def any_epoch(drive: Drive) -> None:
    judge = drive.admission.gate.judge
    drive.admission.gate.judge = lambda proof, *rest: judge(
        proof and proof._replace(epoch=drive.admission.gate.epoch), *rest
    )


def replays(drive: Drive) -> None:
    judge = drive.admission.gate.judge

    def forget(proof: Proof | None, *rest: float) -> Refusal | None:
        if proof and (seen := drive.admission.gate._senders.get(proof.sender)):
            seen.seq, seen.beat = -1, NEVER
        return judge(proof, *rest)

    drive.admission.gate.judge = forget


def never_silent(drive: Drive) -> None:
    drive.admission.silences.silent = lambda claim, now: False


def never_idle(drive: Drive) -> None:
    drive.admission.silences.idle = lambda claim, now: False


def nobody_must_act(drive: Drive) -> None:
    never_idle(drive)
    lenient(Refusal.OPERATOR_IDLE, drive=drive)


def free_without_a_floor(drive: Drive) -> None:
    drive.admission.gate.begin_after = lambda now, why: None


def any_release(drive: Drive) -> None:
    obey = drive.admission.latch.obey

    def forget(said: Stop) -> bool:
        if said.engaged or not drive.admission.latch.stops:
            return obey(said)
        drive.admission.latch.forget([stop.id for stop in drive.admission.latch.stops])
        return True

    drive.admission.latch.obey = forget


def deaf_to_stops(drive: Drive) -> None:
    drive.admission.stop = lambda said, now: False


def no_long_loss(drive: Drive) -> None:
    gate, since = drive.admission.gate, drive.admission.foreign._since
    drive.admission.gate = Gate(gate._deadlines, gate.epoch, since)
    drive.admission.gate._measure_loss = lambda *of_a_sender: None


def rights_for_all(drive: Drive) -> None:
    interrupt = drive.admission.gate.interrupt
    drive.admission.gate.interrupt = lambda now, limit: interrupt(now, float("inf"))


def no_interruption(drive: Drive) -> None:
    drive.admission.gate.interrupt = lambda now, limit: None


def rights_outlive_a_release(drive: Drive) -> None:
    gate = drive.admission.gate
    gate._may_begin = lambda proof, seen: (
        proof.began <= proof.acted
        and (proof.began == seen.right or proof.began > max(seen.floor, gate._floor))
    )


def never_late(drive: Drive) -> None:
    drive.admission.late = lambda now: 0.0


def claims_outlive_a_rest(drive: Drive) -> None:
    drive.admission.mux.clear = lambda: None


def departures_unheard(drive: Drive) -> None:
    drive.admission.withdraw = lambda sender, now: None


def foreign_at_once(drive: Drive) -> None:
    meet = drive.admission.foreign._meet

    def meet_anew(source: str) -> object:
        prover = meet(source)
        prover._moving = False
        return prover

    drive.admission.foreign._meet = meet_anew


BEFORE_NEUTRAL = Refusal.NOT_FROM_NEUTRAL, Refusal.BEFORE_RELEASE, Refusal.BEFORE_REPAIR
DEFECTS: dict[str, tuple[Sabotage, bool]] = {
    "a claim may begin at any time": (lambda drive: lenient(*BEFORE_NEUTRAL, drive=drive), True),
    "a command may have any age": (lambda drive: lenient(Refusal.STALE, drive=drive), True),
    "a command may be of any epoch": (any_epoch, True),
    "a command may be repeated": (replays, False),  # within the age it has, and the grace
    "no link is lost for long": (no_long_loss, True),
    "every claim may go on after an interruption": (rights_for_all, False),
    "interruptions end without a trace": (no_interruption, False),
    "a right to go on outlives a release": (rights_outlive_a_release, False),
    "silence is not heard": (never_silent, True),
    "idle claims are chosen": (never_idle, False),
    "nobody must act": (nobody_must_act, True),
    "what is free need not begin anew": (free_without_a_floor, True),
    "any release releases": (any_release, True),
    "stops are not heard": (deaf_to_stops, True),
    "claims outlive a rest": (claims_outlive_a_rest, False),
    "departures are not heard": (departures_unheard, False),
    "a pause goes unnoticed": (never_late, False),
    "foreign senders drive on after a start": (foreign_at_once, False),
}
"""What is done to a drive, and whether the watchdog's judge would stop the robot for it too."""


@pytest.mark.parametrize("name", DEFECTS)
def test_the_walk_finds_a_defect_and_so_does_the_judge_where_it_must(name: str) -> None:
    sabotage, judge_too = DEFECTS[name]
    world = World(Random(5), sabotage)  # which finds them soonest
    while world.steps < 200_000 and not (world.unsafe and (world.alarm or not judge_too)):
        walk(world, world.steps + 500)
    assert world.unsafe
    if judge_too:
        assert world.alarm
