"""What a trial concludes from the chip alone; the bench is one whose wheels follow a script."""

from collections.abc import Callable
from types import SimpleNamespace

import pytest

from zteleop.chaos import trial
from zteleop.chaos.fault import Fault
from zteleop.chaos.trial import judge


class Scripted:
    """A bench whose wheels turn until `stops`, rest, and turn again at `starts`, in its own time."""

    notes: list[str] = []

    def __init__(self, stops: float, starts: float = float("inf")) -> None:
        self.now, self.stops, self.starts = 0.0, stops, starts
        self.watchdog = self.eye = self
        self.words = "it said nothing"

    def path(self) -> list[int]:
        return []

    @property
    def at_rest(self) -> bool:
        return self.stops <= self.now < self.starts

    def until(self, condition: "Callable[[], object]", patience: float) -> float | None:
        end = self.now + patience
        while not condition():
            if self.now > end:
                return None
            self.now += 0.001
        return self.now

    def monotonic(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


def done(bench: Scripted, fault: Fault, monkeypatch: pytest.MonkeyPatch) -> trial.Outcome:
    monkeypatch.setattr(trial, "time", bench)
    return judge(bench, fault)  # type: ignore[arg-type]


STRUCK = Fault("struck", lambda bench: None, 0.05)


def test_the_time_until_rest_is_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    found = done(Scripted(stops=0.03), STRUCK, monkeypatch)
    assert found.seconds == pytest.approx(0.03, abs=0.002)
    assert found.broken == ""


def test_a_strike_that_takes_its_time_says_from_when_on_it_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    fault = STRUCK._replace(strike=lambda bench: bench.sleep(3.0) or bench.monotonic())  # type: ignore[attr-defined]
    assert done(Scripted(stops=3.02), fault, monkeypatch).seconds == pytest.approx(0.02, abs=0.002)


def test_wheels_that_never_stop(monkeypatch: pytest.MonkeyPatch) -> None:
    assert done(Scripted(stops=1e9), STRUCK, monkeypatch).broken == "its wheels still turned 5 s later"


def test_wheels_that_start_again(monkeypatch: pytest.MonkeyPatch) -> None:
    found = done(Scripted(stops=0.03, starts=0.4), STRUCK, monkeypatch)
    assert found.broken == "it moved again without being begun anew"


def test_whoever_must_drive_on_and_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    fault = STRUCK._replace(bound=None, then="drives")
    assert done(Scripted(stops=0.1), fault, monkeypatch).broken.startswith(
        "it did not drive again within 5 s"
    )
    assert done(Scripted(stops=0.1, starts=2.0), fault, monkeypatch).broken == ""


def test_the_chip_is_looked_at_before_anything_that_may_take_long() -> None:
    looks: list[str] = []
    meter = SimpleNamespace(glance=lambda: looks.append("meter"))
    seen = iter([False, True])

    class Eye:
        @property
        def at_rest(self) -> bool:
            looks.append("chip")
            return next(seen)

    bench = SimpleNamespace(eye=Eye())
    assert [trial._rests(bench, meter) for _ in range(2)] == [False, True]  # type: ignore[arg-type]
    assert looks == ["chip", "meter", "chip"]
