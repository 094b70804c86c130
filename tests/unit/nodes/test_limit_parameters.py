import pytest
from unit.nodes.fakes import LimitsShelf

from zteleop.control.drive import Drive
from zteleop.control.limiter import Limits
from zteleop.control.mixer import Ackermann
from zteleop.control.settings import DriveSettings
from zteleop.errors import ConfigError
from zteleop.nodes.limit_parameters import LIMITS, LimitParameters
from zteleop.testing import FakeNode

SETTINGS = DriveSettings(limits=Limits(speed=2.0))


class Bench:
    def __init__(self, shelf: LimitsShelf | None = None, settings: DriveSettings = SETTINGS) -> None:
        self.node, self.shelf = FakeNode(), shelf or LimitsShelf()
        self.drive = Drive(settings, 4.08, 1, 0.0)
        self.notes: list[str] = []
        LimitParameters(self.node, self.drive, self.shelf, self.notes.append)  # type: ignore[arg-type]

    def set(self, name: str, value: float) -> None:
        self.node.parameters[name if "." in name else f"limits.{name}"].set(value)


def test_each_limit_is_a_parameter_that_begins_as_the_settings_say() -> None:
    bench = Bench()
    silences = [f"sources.{name}.silence" for name in SETTINGS.known_sources]
    assert list(bench.node.parameters) == [*LIMITS, *silences]
    values = {name: one.value for name, one in bench.node.parameters.items()}
    assert (values["limits.speed"], values["limits.acceleration"]) == (2.0, 3.0)
    assert values["limits.turn"] == pytest.approx(Ackermann().max_turn)
    assert bench.shelf.values == {}


def test_what_the_settings_leave_to_the_vehicle_is_a_number_of_its_own() -> None:
    bench = Bench(settings=DriveSettings())
    assert bench.node.parameters["limits.speed"].value == Ackermann().max_speed


def test_a_limit_is_narrowed_at_once_kept_and_noted() -> None:
    bench = Bench()
    bench.set("speed", 0.3)
    assert bench.drive.limits.speed == 0.3
    assert bench.drive.settings.limits.speed == 2.0
    assert (bench.shelf.values, bench.notes) == ({"limits.speed": 0.3}, ["limits.speed is 0.3"])
    bench.set("turn", 1.0)
    assert bench.shelf.values == {"limits.speed": 0.3, "limits.turn": 1.0}
    bench.set("speed", 2.0)
    assert bench.shelf.values == {"limits.turn": 1.0}


@pytest.mark.parametrize("value", [2.1, 0.0, -1.0, 0.019])
def test_none_is_wider_than_the_settings_and_none_is_a_stop(value: float) -> None:
    bench = Bench()
    with pytest.raises(ConfigError, match=r"expected 0.02 to 2, found"):
        bench.set("speed", value)
    assert (bench.drive.limits.speed, bench.shelf.values) == (2.0, {})


def test_what_was_set_before_holds_after_a_restart() -> None:
    bench = Bench(LimitsShelf({"limits.speed": 0.3, "limits.turn": 0.5}))
    assert (bench.drive.limits.speed, bench.drive.limits.turn) == (0.3, 0.5)
    assert bench.node.parameters["limits.speed"].value == 0.3


@pytest.mark.parametrize(("kept", "holds"), [(9.0, 2.0), (0.0, 0.02), (-3.0, 0.02)])
def test_what_was_kept_is_no_wider_than_the_settings_of_today(kept: float, holds: float) -> None:
    assert Bench(LimitsShelf({"limits.speed": kept, "wings": 3.0})).drive.limits.speed == pytest.approx(holds)


def test_a_disk_that_keeps_nothing_is_told_of_and_the_limit_holds() -> None:
    shelf = LimitsShelf()
    shelf.full = True
    bench = Bench(shelf)
    bench.set("speed", 0.3)
    assert bench.drive.limits.speed == 0.3
    assert bench.node.warnings == ["limits.speed holds, but not across a restart: no space left"]


def test_a_file_that_cannot_be_read_is_told_of_and_the_settings_hold() -> None:
    shelf = LimitsShelf({"limits.speed": 0.3})
    shelf.torn = True
    bench = Bench(shelf)
    assert bench.drive.limits.speed == 2.0
    (words,) = bench.node.warnings
    assert words.startswith("limits that were set before are not known")


def test_a_source_may_be_silent_for_less_time_and_never_for_more() -> None:
    bench = Bench()
    silences = bench.drive.admission.silences
    bench.set("sources.program.silence", 0.2)
    assert (silences.of("program"), silences.of("keyboard")) == (0.2, 0.3)
    assert bench.shelf.values == {"sources.program.silence": 0.2}
    for value in (0.51, 0.19):
        with pytest.raises(ConfigError, match=r"expected 0.2 to 0.5"):
            bench.set("sources.program.silence", value)
    assert Bench(bench.shelf).drive.admission.silences.of("program") == 0.2


def test_the_time_without_an_act_is_shortened_and_never_lengthened() -> None:
    bench = Bench()
    bench.set("deadlines.operator", 2.0)
    assert bench.drive.admission.operator_silence == bench.drive.admission.gate.operator_silence == 2.0
    assert bench.shelf.values == {"deadlines.operator": 2.0}
    for value in (5.1, 0.4):
        with pytest.raises(ConfigError, match=r"expected 0.5 to 5"):
            bench.set("deadlines.operator", value)
    assert Bench(bench.shelf).drive.admission.operator_silence == 2.0
