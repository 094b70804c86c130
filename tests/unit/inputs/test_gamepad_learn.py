import pytest

from zteleop.inputs.gamepad_learn import ASK, Lesson
from zteleop.inputs.gamepad_map import FORGET, Moved

FOUND = {
    **{"ABS_X": 0.0, "ABS_Y": 0.0, "ABS_Z": -1.0, "ABS_HAT0Y": 0.0},
    **{"BTN_SOUTH": 0.0, "BTN_EAST": 0.0, "BTN_TL": 0.0, "BTN_TL2": 0.0, "BTN_TR": 0.0},
}


class Pupil:
    def __init__(self, **found: float) -> None:
        self.lesson = Lesson()
        self.found = {**FOUND, **found}
        self.take(FORGET, *(Moved(*item) for item in self.found.items()))

    def take(self, *moved: Moved) -> None:
        for one in moved:
            self.lesson.heed(one)

    def push(self, name: str, *places: float) -> None:
        """Move a control to some places, and let it go."""
        self.take(*(Moved(name, place) for place in (*places, self.found[name])))

    def learn(self, **controls: tuple[str, float]) -> None:
        for name, place in controls.values():
            self.push(name, place)


@pytest.fixture
def bench() -> Pupil:
    bench = Pupil()
    assert bench.lesson.question == ASK[""]
    bench.push("BTN_SOUTH", 1.0)
    assert bench.lesson.question == ASK["forward"]
    return bench


@pytest.fixture
def buttons(bench: Pupil) -> Pupil:
    bench.push("ABS_Y", -0.5, -1.0, -0.3)
    assert bench.lesson.question == ASK["turn"]
    bench.push("ABS_X", -0.9, 0.4)  # a spring goes beyond the middle
    assert bench.lesson.question == ASK["deadman"]
    return bench


def test_everything_is_asked_for_in_turn(buttons: Pupil) -> None:
    for use, name in (
        ("deadman", "BTN_TL"),
        ("turbo", "BTN_TR"),
        ("stop", "BTN_EAST"),
        ("release", "BTN_SOUTH"),
    ):
        assert buttons.lesson.question == ASK[use]
        buttons.push(name, 1.0)
    assert buttons.lesson.done
    assert buttons.lesson.question == ""


def test_what_was_learned_is_a_mapping() -> None:
    bench = Pupil(BTN_SELECT=0.0)
    bench.push("BTN_SOUTH", 1.0)
    for name, place in (
        ("ABS_Y", 1.0),
        ("ABS_X", -1.0),
        ("ABS_Z", 1.0),
        ("BTN_TR", 1.0),
        ("ABS_HAT0Y", -1.0),
    ):
        bench.push(name, place)
    bench.push("ABS_Z", 1.0)
    settings = bench.lesson.settings
    assert (settings.forward, settings.turn, settings.deadman) == ("ABS_Y", "-ABS_X", "ABS_Z")
    assert (settings.turbo, settings.stop, settings.release) == ("BTN_TR", "-ABS_HAT0Y", "")


def test_a_stick_that_was_never_moved_is_at_rest_where_it_returns_to() -> None:
    bench = Pupil(ABS_Y=-1.0)  # the kernel says 0 of 255 until the first report
    bench.push("ABS_Y", 1.0, 0.02)
    bench.found["ABS_Y"] = 0.0
    bench.take(Moved("ABS_Y", 0.0))
    bench.push("BTN_SOUTH", 1.0)
    bench.push("ABS_Y", -1.0)
    assert bench.lesson.question == ASK["turn"]
    bench.push("ABS_X", -1.0)
    for name in ("BTN_TL", "BTN_TR", "BTN_EAST", "BTN_SOUTH"):
        bench.push(name, 1.0)
    assert bench.lesson.settings.forward == "-ABS_Y"


def test_a_stick_pushed_a_little_is_no_answer(bench: Pupil) -> None:
    bench.push("ABS_Y", -0.5)
    assert bench.lesson.question == ASK["forward"]
    assert bench.lesson.complaint == ""


def test_a_trigger_is_no_stick_and_a_stick_no_button(bench: Pupil) -> None:
    bench.push("ABS_Z", 1.0)
    assert bench.lesson.complaint == "a stick is meant"
    bench.push("BTN_SOUTH", 1.0)
    assert bench.lesson.question == ASK["forward"]
    bench.push("ABS_Y", -1.0)
    assert bench.lesson.complaint == ""


def test_nothing_is_learned_before_it_is_let_go(bench: Pupil) -> None:
    bench.take(Moved("ABS_Y", -1.0))
    assert bench.lesson.question == ASK["forward"]
    bench.take(Moved("ABS_Y", 0.0))
    assert bench.lesson.question == ASK["turn"]


def test_a_stick_that_is_taken_is_refused(bench: Pupil) -> None:
    bench.push("ABS_Y", -1.0)
    bench.push("ABS_Y", 1.0)
    assert bench.lesson.complaint == "that is ABS_Y, which is forward already"
    assert bench.lesson.question == ASK["turn"]


def test_a_trigger_that_is_a_button_as_well_is_the_button(buttons: Pupil) -> None:
    buttons.take(Moved("ABS_Z", 0.5), Moved("BTN_TL2", 1.0), Moved("ABS_Z", 1.0))
    buttons.take(Moved("BTN_TL2", 0.0), Moved("ABS_Z", -1.0))
    assert buttons.lesson.question == ASK["turbo"]
    buttons.push("BTN_TR", 1.0)
    buttons.push("BTN_TR", 1.0)
    assert buttons.lesson.complaint == "that is BTN_TR, which is turbo already"


def test_another_pad_begins_anew(buttons: Pupil) -> None:
    buttons.take(FORGET)
    assert buttons.lesson.question == ASK[""]
