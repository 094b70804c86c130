import threading
from types import SimpleNamespace
from typing import Any

import msgspec
import pytest

from zteleop.bridges.web.pressed import Pressed
from zteleop.bridges.web.questions import BEGIN, LATE, SEEN, Questions, Sitting
from zteleop.bridges.web.slots import Slots
from zteleop.bridges.web.words import Asks, Press, Wish
from zteleop.messages import Beat

ASKS = Asks(1, 7, "throttle", "the wheels turn", False, [], "idle", "nobody drives", "", {}, None, 0.0)


class Page:
    """A page of somebody, and what it was told."""

    def __init__(self, questions: Questions, name: str) -> None:
        self.slots = Slots(lambda: None)
        self._questions = questions
        self._name = name
        questions.join(name, self.slots)

    def told(self) -> list[Any]:
        found = []
        while (frame := self.slots.take()) is not None:
            found.append(msgspec.json.decode(frame))
        return found

    def press(self, key: str, beat: float = 10.0) -> None:
        self._questions.hear(self._name, Press(key, beat))


@pytest.fixture
def questions() -> Questions:
    return Questions("abe", "1")


def sit(questions: Questions, time: float = 10.0) -> list[str]:
    """Let somebody answer; return what he presses."""
    pressed: list[str] = []
    heard = SimpleNamespace(beat=Beat(1, time, 0.0))
    loop = SimpleNamespace(call_soon=lambda act: act())
    node: Any = SimpleNamespace(membership=SimpleNamespace(heard=lambda: heard, loop=loop))
    questions.sit(Sitting(node, pressed.append))
    return pressed


def test_whoever_comes_is_told_what_is_asked_and_any_may_answer(questions: Questions) -> None:
    first = Page(questions, "page 1")
    pressed = sit(questions)
    questions.tell(ASKS)
    second = Page(questions, "page 2")
    assert [word["is"] for word in first.told()] == ["hello", "asks"]
    assert [word["is"] for word in second.told()] == ["hello", "asks"]
    first.press("up")
    second.press("enter")
    questions.hear("page 1", Wish("stop"))
    assert pressed == ["up", "enter"]


@pytest.mark.parametrize(
    ("key", "counts"), [("up", False), ("enter", False), ("backspace", True), ("q", True)]
)
def test_a_press_that_comes_late_turns_nothing_and_rest_is_never_late(
    questions: Questions, key: str, counts: bool
) -> None:
    page, pressed = Page(questions, "page 1"), sit(questions)
    page.press(key, 10.0 - LATE - 0.1)
    assert bool(pressed) is counts
    notes = [word["says"] for word in page.told() if word["is"] == "note"]
    assert notes == ([] if counts else ["that press came late, and counts for nothing: press again"])


def test_it_begins_when_somebody_says_so_and_not_by_another_key(questions: Questions) -> None:
    page = Page(questions, "page 1")
    begun = threading.Thread(target=questions.await_begin, args=(["Lift it."], "wheels up"), daemon=True)
    begun.start()
    for key in ("up", "enter", "q"):
        page.press(key)
    begun.join(0.05)
    assert begun.is_alive()
    assert {"is": "told", "lines": ["Lift it."], "begins": "wheels up", "ends": False} in page.told()
    page.press(BEGIN)
    begun.join()
    assert sit(questions) == [], "a q before that ends nothing"


def test_the_last_word_is_waited_for_until_a_page_has_shown_it_or_none_is_open(questions: Questions) -> None:
    page = Page(questions, "page 1")
    questions.tell(ASKS)
    ended = threading.Thread(target=questions.end, args=(["written"], 60.0), daemon=True)
    ended.start()
    while not any(word["is"] == "told" and word["ends"] for word in page.told()):
        pass
    page.press(SEEN)
    ended.join()
    questions.leave("page 1")
    questions.end(["written"], 60.0)


def test_a_page_that_is_closed_while_the_last_word_is_said_is_not_waited_for(questions: Questions) -> None:
    page = Page(questions, "page 1")
    ended = threading.Thread(target=questions.end, args=(["written"], 60.0), daemon=True)
    ended.start()
    while not any(word["is"] == "told" and word["ends"] for word in page.told()):
        pass
    questions.leave("page 1")
    ended.join()


def test_between_two_parts_no_press_counts(questions: Questions) -> None:
    page, pressed = Page(questions, "page 1"), sit(questions)
    questions.sit(None)
    page.press("up")
    assert pressed == []
    assert {"is": "told", "lines": ["the robot is started anew"], "begins": "", "ends": False} in page.told()


def test_a_stop_while_the_robot_starts_is_kept_until_it_can_be_heard_and_nothing_else_is(
    questions: Questions,
) -> None:
    page = Page(questions, "page 1")
    for key in ("up", "backspace", "enter", "backspace"):
        page.press(key)
    assert sit(questions) == ["backspace"]
    assert sit(questions) == []


def test_what_is_pressed_is_read_once() -> None:
    keys = Pressed()
    keys.press("up")
    keys.press("enter")
    assert [key.name for key in keys.read(0.0)] == ["up", "enter"]
    keys.press("up")
    keys.close()
    assert keys.read(0.0) == []
