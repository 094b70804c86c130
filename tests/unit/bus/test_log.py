import pytest

from zteleop.bus.log import NodeLog
from zteleop.messages import Log
from zteleop.testing import Clock


class Ears:
    """A log, and everything that was heard of it."""

    def __init__(self) -> None:
        self.said: list[Log] = []
        self.shown: list[str] = []
        self.log = NodeLog("nose", self.said.append, self.shown.append)

    @property
    def texts(self) -> list[str]:
        return [log.msg for log in self.said]


@pytest.fixture
def ears(clock: Clock) -> Ears:
    return Ears()


def test_a_sentence_is_said_on_the_bus_and_shown_here(ears: Ears) -> None:
    ears.log.info("all is well")
    ears.log.warn("smells odd")
    ears.log.error("on fire")
    assert [(log.level, log.name, log.msg) for log in ears.said] == [
        (Log.INFO, "nose", "all is well"),
        (Log.WARN, "nose", "smells odd"),
        (Log.ERROR, "nose", "on fire"),
    ]
    assert ears.shown == ["nose: info: all is well", "nose: warning: smells odd", "nose: error: on fire"]
    assert ears.said[0].stamp.sec > 0


def test_what_goes_on_is_spoken_of_ever_more_seldom_and_what_was_held_back_is_counted(
    ears: Ears, clock: Clock
) -> None:
    for number in range(80):
        ears.log.warn(f"smells odd {number}", "smell")
        clock.pass_by(0.1)
    assert ears.texts == [
        "smells odd 0",
        "smells odd 10 (and 9 times more since that was told last)",
        "smells odd 30 (and 19 times more since that was told last)",
        "smells odd 70 (and 39 times more since that was told last)",
    ]
    clock.pass_by(1.0)
    ears.log.warn("smells again", "smell")
    ears.log.warn("smells again", "smell")
    assert ears.texts[4:] == ["smells again"], "what was quiet is news"


def test_what_was_held_back_of_one_thing_is_said_of_no_other(ears: Ears, clock: Clock) -> None:
    for number in range(15):
        ears.log.warn("smells odd", f"smell {number}")
    ears.log.info("all is well")
    clock.pass_by(1.0)
    ears.log.warn("on fire")
    assert ears.texts[10:] == ["all is well", "on fire (5 other warnings left out)"]


def test_however_long_it_goes_on_it_is_told_twice_a_minute(ears: Ears, clock: Clock) -> None:
    for _ in range(6000):
        ears.log.warn("smells odd")
        clock.pass_by(0.1)
    assert len(ears.said) == 24


def test_what_goes_on_takes_no_others_place(ears: Ears, clock: Clock) -> None:
    for _ in range(50):
        for number in range(10):
            ears.log.warn("smells odd", f"subject {number}")
        clock.pass_by(0.1)
    ears.log.warn("something else")
    assert ears.texts[-1].startswith("something else")


def test_without_a_subject_a_sentence_is_its_own(ears: Ears) -> None:
    for text in ("a", "b", "a", "b"):
        ears.log.warn(text)
    ears.log.error("a")
    ears.log.info("b")
    assert ears.texts == ["a", "b"]


def test_a_second_later_a_subject_may_be_spoken_of_again(ears: Ears, clock: Clock) -> None:
    ears.log.info("a")
    clock.pass_by(1.0)
    ears.log.info("a")
    assert ears.texts == ["a", "a"]


def test_a_flood_of_subjects_is_bounded_and_so_is_what_is_remembered(ears: Ears, clock: Clock) -> None:
    for number in range(3000):
        ears.log.warn("smells odd", f"subject {number}")
        clock.pass_by(0.001)
    assert len(ears.said) <= 40
    assert len(ears.log._said) <= 10
    counted = sum(int(text.split("(")[1].split()[0]) for text in ears.texts if "(" in text)
    assert len(ears.said) + counted + ears.log._held_back == 3000


def test_a_long_text_is_cut(ears: Ears) -> None:
    ears.log.warn("x" * 10_000)
    assert ears.texts == ["x" * 500]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("\x1b[2J", "\\u001b[2J"),
        ("two\nlines", "two\\u000alines"),
        ("\x9b\u202e", "\\u009b\\u202e"),
        ("\ud800", "\\ud800"),
        ("Straße 東京", "Straße 東京"),
    ],
)
def test_what_could_steer_a_terminal_is_escaped(ears: Ears, text: str, said: str) -> None:
    ears.log.warn(text)
    assert ears.texts == [said]
    assert ears.shown == [f"nose: warning: {said}"]


def test_the_listener_may_change(ears: Ears) -> None:
    elsewhere: list[str] = []
    ears.log.show = elsewhere.append
    ears.log.info("a")
    assert (ears.shown, elsewhere) == ([], ["nose: info: a"])


@pytest.mark.parametrize(
    ("level", "told"),
    [
        ("debug", ["a", "b", "c", "d"]),
        ("info", ["b", "c", "d"]),
        ("warn", ["c", "d"]),
        ("error", ["d"]),
    ],
)
def test_only_what_is_of_a_level_or_above_is_told(ears: Ears, level: str, told: list[str]) -> None:
    ears.log.tell_from(level)
    for say, text in zip((ears.log.debug, ears.log.info, ears.log.warn, ears.log.error), "abcd", strict=True):
        say(text)
    assert ears.texts == told


def test_without_a_word_debugging_is_told_to_nobody(ears: Ears) -> None:
    ears.log.debug("a")
    assert (ears.texts, ears.shown) == ([], [])
