from itertools import count, pairwise
from types import SimpleNamespace

import pytest

from zteleop.control.drive import Drive
from zteleop.control.proof import Prover
from zteleop.control.settings import DriveSettings
from zteleop.control.slowness import QUICK_WRITES, SLOW, SLOW_WRITES
from zteleop.errors import DeviceError
from zteleop.messages import Beat, Pwm, Stop
from zteleop.nodes import output as module
from zteleop.nodes.output import FAILED_STEPS, REPAIR_EVERY, REST_AGAIN, REST_WITHIN, Output
from zteleop.testing import Clock, MemoryChip

NEUTRAL = {0: 1509.6, 1: 1530.0}
PULSES = {0: 1509.6, 1: 1600.0}


class Workshop:
    """A drive that wants to move, and its output."""

    def __init__(self, arming: float = 0.0) -> None:
        self.now = 100.0
        self.chip = MemoryChip(arming)
        self.drive = Drive(DriveSettings(), 4.08, 1, self.now)
        self.said: list[str] = []
        self.output = Output(self.chip, self.drive, self.said.append)
        self.prover = Prover(7)
        self.output.start(self.now)

    @property
    def state(self) -> str:
        return self.drive.step(self.now).state

    def push(self) -> None:
        """Claim the robot, as somebody who begins now and holds on."""
        beat = Beat(1, self.now, 0.0)
        self.prover.act(beat)
        self.drive.receive("keyboard", Pwm(390, 370), self.prover.prove(beat, True, self.now), self.now)

    def step(self, seconds: float = 0.02) -> str:
        self.now += seconds
        self.output.tend(self.now)
        step = self.drive.step(self.now)
        self.output.write(step.pulse_us, self.now)
        return step.state

    def break_down(self) -> None:
        self.chip.broken |= {"write", "check", "start"}
        self.output.check(self.now)


@pytest.fixture
def bench() -> Workshop:
    bench = Workshop()
    bench.step()
    bench.step()
    return bench


def test_it_starts_at_neutral_and_writes_what_it_is_told(bench: Workshop) -> None:
    assert (bench.chip.log[0], bench.chip.writes[0]) == ("start", NEUTRAL)
    bench.output.write(PULSES, bench.now)
    assert bench.chip.pulses == PULSES
    bench.output.rest()
    assert bench.chip.pulses == NEUTRAL
    bench.output.close()
    assert bench.chip.log[-1] == "close"


def test_a_chip_that_does_not_come_up_is_an_error() -> None:
    chip = MemoryChip()
    chip.broken.add("start")
    output = Output(chip, Drive(DriveSettings(), 4.08, 1, 0.0), print)
    with pytest.raises(DeviceError):
        output.start(0.0)


def test_neutral_is_held_while_the_esc_arms_after_every_start() -> None:
    bench = Workshop(arming=2.0)
    assert bench.step(1.99) == "starting"
    assert bench.drive.admission.holds.strongest.why == "neutral for 2 s while the ESC arms"
    bench.push()
    assert bench.step(0.02) == "idle"
    bench.push()
    assert bench.step() == "idle", "what began while it armed moves it"


def test_only_failed_steps_in_a_row_are_a_fault(bench: Workshop) -> None:
    for _ in range(3):
        bench.chip.broken.add("write")
        for _ in range(FAILED_STEPS - 1):
            bench.step()
        bench.chip.broken.clear()
        bench.step()
        assert bench.said == []
    bench.chip.broken.add("write")
    for _ in range(FAILED_STEPS):
        bench.step()
    assert bench.state == "fault"


def test_a_fault_is_said_in_words(bench: Workshop) -> None:
    bench.chip.broken.add("write")
    for _ in range(FAILED_STEPS):
        bench.step()
    assert bench.said == ["the chip is at fault: the chip does not take a write"]
    assert bench.drive.admission.holds.strongest.why == "the chip does not take a write"


def test_a_chip_that_forgot_is_a_fault_although_writes_succeed(bench: Workshop) -> None:
    bench.chip.broken.add("check")
    bench.output.check(bench.now)
    assert bench.state == "fault"
    assert bench.chip.log.count("check") == 2


def test_a_single_disturbed_check_is_no_fault(bench: Workshop) -> None:
    def disturbed() -> None:
        bench.chip.check = lambda: None
        raise DeviceError("noise")

    bench.chip.check = disturbed
    bench.output.check(bench.now)
    assert (bench.state, bench.said) == ("idle", [])


def test_while_broken_nothing_but_neutral_is_written(bench: Workshop) -> None:
    bench.break_down()
    bench.chip.broken -= {"write", "check"}
    before = list(bench.chip.writes)
    bench.chip.log.clear()
    for _ in range(50):
        bench.push()
        bench.step()
        bench.output.write(PULSES, bench.now)
        bench.output.check(bench.now)
    assert set(bench.chip.log) == {"write", "start"}
    assert all(written == NEUTRAL for written in bench.chip.writes[len(before) :])


def test_a_chip_at_fault_gets_neutral_first_and_at_every_step(bench: Workshop) -> None:
    bench.break_down()
    bench.chip.log.clear()
    for _ in range(20):
        bench.step(0.01)
    assert bench.chip.log[:3] == ["write", "start", "write"]
    assert bench.chip.log.count("write") == 20


def test_a_bus_on_which_neutral_takes_long_is_asked_for_nothing_more(
    bench: Workshop, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench.break_down()
    bench.chip.broken.clear()
    monkeypatch.setattr(module, "clock", SimpleNamespace(now=count(step=SLOW + 0.01).__next__))
    bench.chip.log.clear()
    for _ in range(20):
        bench.step()
    assert set(bench.chip.log) == {"write"}
    monkeypatch.undo()
    bench.step()
    assert bench.chip.log[-2:] == ["start", "write"]
    assert bench.state == "idle"


def test_it_is_repaired_at_once_and_then_ten_times_a_second(bench: Workshop) -> None:
    bench.break_down()
    tries = []
    for _ in range(100):
        count = bench.chip.log.count("start")
        bench.step(0.01)
        if bench.chip.log.count("start") > count:
            tries.append(bench.now)
    assert tries[0] == pytest.approx(100.05)
    gaps = [b - a for a, b in pairwise(tries)]
    assert all(REPAIR_EVERY - 1e-9 <= gap <= REPAIR_EVERY + 0.011 for gap in gaps)
    assert len(tries) >= 9


def test_the_newest_reason_of_a_fault_is_shown(bench: Workshop) -> None:
    bench.chip.broken |= {"write", "start"}
    for _ in range(FAILED_STEPS + 1):
        bench.step()
    assert bench.drive.admission.holds.strongest.why == "the chip does not take a start"


def test_repaired_it_is_at_neutral_and_what_was_held_moves_nothing(bench: Workshop) -> None:
    bench.push()
    bench.step()
    assert bench.chip.pulses != NEUTRAL
    bench.break_down()
    bench.push()
    bench.step(0.2)
    bench.chip.broken.clear()
    bench.push()
    assert bench.step(0.2) == "idle"
    assert bench.said[-1] == "the chip is back, at neutral"
    for _ in range(20):
        bench.push()
        bench.step()
    assert bench.chip.pulses == NEUTRAL
    bench.step(1.0)  # let go
    bench.push()
    bench.step()
    assert bench.chip.pulses != NEUTRAL


def test_repaired_the_esc_arms_once_more() -> None:
    bench = Workshop(arming=2.0)
    assert bench.step(2.0) == "idle"
    bench.break_down()
    assert bench.step() == "fault"
    bench.chip.broken.clear()
    assert bench.step(0.2) == "starting"
    assert bench.step(1.98) == "starting"
    assert bench.step(0.04) == "idle"


def test_failures_before_a_repair_do_not_count_after_it(bench: Workshop) -> None:
    bench.chip.broken |= {"write"}
    for _ in range(FAILED_STEPS):
        bench.step()
    assert bench.state == "fault"
    bench.step(0.2)  # repaired: it takes a start
    assert bench.state == "idle"
    bench.step()
    assert bench.state == "idle"


def test_neutral_that_is_not_taken_at_the_end_is_tried_for_a_while(
    bench: Workshop, monkeypatch: pytest.MonkeyPatch
) -> None:
    waits: list[float] = []

    def sleep(seconds: float) -> None:
        waits.append(seconds)
        if len(waits) == 20:
            bench.chip.broken.clear()

    monkeypatch.setattr(module, "time", SimpleNamespace(sleep=sleep))
    bench.output.write(PULSES, bench.now)
    bench.chip.broken.add("write")
    bench.output.rest()
    assert bench.chip.pulses == NEUTRAL
    assert waits == [REST_AGAIN] * 20


def test_neutral_that_is_never_taken_at_the_end_is_an_error(
    bench: Workshop, monkeypatch: pytest.MonkeyPatch
) -> None:
    waits: list[float] = []
    monkeypatch.setattr(module, "time", SimpleNamespace(sleep=waits.append))
    bench.chip.broken.add("write")
    with pytest.raises(DeviceError):
        bench.output.rest()
    assert sum(waits) == pytest.approx(REST_WITHIN, abs=2 * REST_AGAIN)


def test_a_bus_that_hangs_at_each_try_is_tried_for_no_longer(
    bench: Workshop, monkeypatch: pytest.MonkeyPatch
) -> None:
    times, waits = iter(range(1000)), list[float]()
    monkeypatch.setattr(module, "time", SimpleNamespace(sleep=waits.append))
    monkeypatch.setattr(module, "clock", SimpleNamespace(now=lambda: 0.4 * next(times)))
    bench.chip.broken.add("write")
    with pytest.raises(DeviceError):
        bench.output.rest()
    assert len(waits) <= 3


def stop(bench: Workshop) -> None:
    bench.drive.admission.stop(Stop(engaged=True, id=7, by="ann@desk", why=""), bench.now)
    bench.step()
    bench.output.confirm()


def test_what_the_chip_took_last_is_known_and_when(bench: Workshop, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "clock", SimpleNamespace(now=lambda: bench.now))
    bench.step()
    assert bench.output.evidence == (NEUTRAL, bench.now, "")
    then = bench.now
    bench.chip.broken |= {"write", "start"}
    bench.push()
    for _ in range(10):
        bench.step()
    assert bench.output.evidence == (NEUTRAL, then, "")


def test_a_stop_is_confirmed_by_what_is_read_back(bench: Workshop) -> None:
    bench.chip.log.clear()
    bench.output.check(bench.now)
    assert "read" not in bench.chip.log
    stop(bench)
    assert bench.output.evidence.confirmed == "read"
    bench.chip.pulses[0] = 1700.0
    bench.output.check(bench.now)
    assert bench.output.evidence.confirmed == ""
    bench.step()
    bench.output.check(bench.now)
    assert bench.output.evidence.confirmed == "read"
    bench.drive.admission.stop(Stop(engaged=False, id=7, by="ann@desk", why=""), bench.now)
    assert bench.output.evidence.confirmed == ""


@pytest.mark.parametrize("broken", ["read", "check", "write"])
def test_a_chip_that_cannot_be_read_confirms_nothing_unless_it_is_cut_off(
    bench: Workshop, broken: str
) -> None:
    stop(bench)
    bench.chip.broken |= {broken, "start"}
    for _ in range(FAILED_STEPS):
        bench.step()
    bench.output.check(bench.now)
    assert bench.output.evidence.confirmed == ""
    bench.output.is_cut = True
    assert bench.output.evidence.confirmed == "cut"


def test_a_chip_that_takes_no_neutral_any_more_confirms_nothing_from_then_on(bench: Workshop) -> None:
    stop(bench)
    bench.chip.broken |= {"write", "start"}
    for _ in range(FAILED_STEPS):
        bench.step()
    assert bench.output.evidence.confirmed == ""


def test_a_fault_is_not_hidden_by_a_stop(bench: Workshop) -> None:
    stop(bench)
    bench.break_down()
    assert bench.step() == "fault"
    bench.chip.broken.clear()
    assert bench.step(REPAIR_EVERY) == "stopped"


class SlowChip(MemoryChip):
    """A chip whose bus takes its time, by the clock of its bench."""

    takes = 0.0

    def __init__(self, clock: Clock) -> None:
        super().__init__()
        self.clock = clock

    def _do(self, name: str, pulse_us: dict[int, float] | None = None) -> None:
        self.clock.time += self.takes
        super()._do(name, pulse_us)


@pytest.fixture
def slow(bench: Workshop, clock: Clock) -> Workshop:
    bench.chip = SlowChip(clock)
    bench.output = Output(bench.chip, bench.drive, bench.said.append)
    bench.output.start(bench.now)
    bench.step()
    bench.step()
    bench.push()
    bench.step()
    assert bench.state == "driving"
    bench.chip.takes = SLOW + 0.01
    return bench


def test_a_slow_bus_is_a_fault_that_names_it_and_gets_neutral_and_nothing_else(slow: Workshop) -> None:
    for _ in range(SLOW_WRITES - 1):
        slow.push()
        assert slow.step() == "driving"
    slow.push()
    slow.step()
    assert slow.step() == "fault"
    assert slow.drive.admission.holds.strongest.why.startswith(
        "its bus is slow: a write took 60 ms, of at most 50; look at"
    )
    slow.chip.log.clear()
    for _ in range(20):
        slow.push()
        slow.step()
        slow.output.check(slow.now)
        slow.output.confirm()
    assert set(slow.chip.log) == {"write"}
    assert slow.chip.pulses == NEUTRAL
    assert len(slow.said) == 1


def test_a_bus_that_is_quick_again_may_be_driven_on_by_who_begins_anew(slow: Workshop) -> None:
    for _ in range(SLOW_WRITES + 1):
        slow.push()
        slow.step()
    slow.chip.takes = 0.0
    for _ in range(QUICK_WRITES):
        assert slow.step() == "fault"
        slow.push()
    for _ in range(10):
        assert slow.step() == "idle"
        slow.prover.prove(Beat(1, slow.now, 0.0), True, slow.now)
    assert slow.said[-1] == "the bus of the chip is quick again"
    slow.prover.let_go()
    slow.push()
    assert slow.step() == "driving"


def test_one_write_that_took_long_is_no_slow_bus(slow: Workshop) -> None:
    for _ in range(10):
        slow.chip.takes = SLOW + 0.01
        slow.push()
        slow.step()
        slow.chip.takes = 0.0
        slow.push()
        assert slow.step() == "driving"
    assert slow.said == []


def test_channels_that_another_program_left_on_are_told_as_nothing_stops_them() -> None:
    bench = Workshop()
    assert bench.said == []
    bench.chip.pulses |= {4: 1500.0, 7: None, 9: 900.0}
    bench.output.start(bench.now)
    (said,) = bench.said
    assert said.startswith(
        "there are pulses on channels 4, 9 of the chip, which are not this robot's and which nothing"
    )
    bench.chip.broken.add("read")
    bench.output.start(bench.now)
    assert len(bench.said) == 1


def test_what_was_read_back_before_is_no_word_of_the_next_stop(bench: Workshop) -> None:
    stop(bench)
    bench.drive.admission.stop(Stop(engaged=False, id=7, by="ann@desk", why=""), bench.now)
    bench.step()
    bench.push()
    assert bench.step() == "driving"
    bench.chip.broken |= {"write", "read"}
    bench.drive.admission.stop(Stop(engaged=True, id=8, by="ann@desk", why=""), bench.now)
    bench.step()
    assert bench.output.evidence.confirmed == ""


def test_a_stop_that_was_confirmed_is_not_on_a_bus_that_has_become_slow(slow: Workshop) -> None:
    slow.chip.takes = 0.0
    stop(slow)
    assert slow.output.evidence.confirmed == "read"
    slow.chip.takes = SLOW + 0.01
    slow.step()
    slow.output.check(slow.now)
    assert slow.output.evidence.confirmed == ""


def test_writes_that_take_long_to_fail_are_the_fault_of_a_chip_that_does_not_answer(slow: Workshop) -> None:
    slow.chip.broken.add("write")
    for _ in range(2 * SLOW_WRITES):
        slow.push()
        slow.step()
    assert slow.said == ["the chip is at fault: the chip does not take a write"]
