import json
from pathlib import Path
from typing import Any

import pytest

from zteleop.messages import Pwm, Twist
from zteleop.recording.journal import ACTS, SENDERS, Detail, Journal
from zteleop.testing import Clock

FORWARD = Twist.planar(0.5)
KEYBOARD, OTHER = 0xC0FFEE, 0xBEEF


class Book:
    """A journal, and what it kept once it is closed."""

    def __init__(self, folder: Path, detail: Detail = "acts") -> None:
        self.folder, self.warnings = folder, list[str]()
        self.journal = Journal(folder, detail, self.warnings.append)

    def hear(
        self, now: float, acted: float | None = 1.0, refusal: str | None = None, sender: int | None = KEYBOARD
    ) -> None:
        self.journal.command("keyboard", sender, FORWARD, acted, refusal, now)

    def lines(self) -> list[dict[str, Any]]:
        self.journal.close()
        return [json.loads(line) for line in (self.folder / "journal.jsonl").read_text().splitlines()]

    def events(self) -> list[str]:
        return [line["event"] for line in self.lines()]


@pytest.fixture
def book(tmp_path: Path) -> Book:
    return Book(tmp_path / "state")


def test_a_sender_that_first_drives_is_named_with_what_it_said(book: Book) -> None:
    book.hear(10.0)
    (line,) = book.lines()
    assert (line["event"], line["source"], line["sender"], line["at"]) == (
        "accepted",
        "keyboard",
        "c0ffee",
        10.0,
    )
    assert line["command"]["linear"]["x"] == 0.5


def test_pulses_are_kept_as_they_were_said(book: Book) -> None:
    book.journal.command("keyboard", KEYBOARD, Pwm(375, 400), 1.0, None, 10.0)
    assert book.lines()[0]["command"] == {"steering_ticks": 375, "throttle_ticks": 400}


def test_a_command_that_is_only_repeated_is_one_line(book: Book) -> None:
    for tick in range(100):
        book.hear(10.0 + tick * 0.05)
    assert book.events() == ["accepted"]


def test_each_new_act_is_a_line(book: Book) -> None:
    for tick in range(3):
        book.hear(10.0 + tick, acted=float(tick))
    assert book.events() == ["accepted", "act", "act"]


@pytest.mark.parametrize(("silence", "events"), [(1.9, ["accepted"]), (2.0, ["accepted", "accepted"])])
def test_a_sender_that_was_silent_for_two_seconds_is_news(
    book: Book, silence: float, events: list[str]
) -> None:
    book.hear(10.0)
    book.hear(10.0 + silence)
    assert book.events() == events


def test_ten_acts_a_second_are_kept_and_the_others_counted(book: Book) -> None:
    for tick in range(27):
        book.hear(10.0 + tick * 0.01, acted=float(tick))
    book.hear(11.0, acted=99.0)
    lines = book.lines()
    assert [line["event"] for line in lines] == ["accepted"] + ["act"] * (ACTS - 1) + ["more", "act"]
    assert lines[ACTS]["count"] == 17


def test_what_was_counted_last_is_said_at_the_end(book: Book) -> None:
    for tick in range(ACTS + 2):
        book.hear(10.0, acted=float(tick))
    assert book.lines()[-1]["count"] == 2


def test_a_flood_of_new_senders_is_bounded_like_acts(book: Book) -> None:
    for sender in range(5 * SENDERS):
        book.hear(10.0, sender=sender)
    assert book.events() == ["accepted"] * ACTS + ["more"]
    assert len(book.journal._accepted) == SENDERS


def test_a_refusal_is_a_line_when_it_changes_and_says_why(book: Book) -> None:
    for tick in range(100):
        book.hear(10.0 + tick * 0.05, refusal="it is too old" if tick < 50 else "let go first")
    lines = book.lines()
    assert [(line["event"], line["why"]) for line in lines] == [
        ("refused", "it is too old"),
        ("refused", "let go first"),
    ]


def test_refusals_that_alternate_are_one_line_a_second(book: Book) -> None:
    for tick in range(300):
        book.hear(10.0 + tick * 0.01, refusal="ab"[tick % 2])
    assert book.events() == ["refused"] * 3


def test_the_same_refusal_is_news_once_its_sender_was_accepted_in_between(book: Book) -> None:
    book.hear(10.0, refusal="it is too old")
    book.hear(11.0)
    book.hear(12.0, refusal="it is too old")
    assert book.events() == ["refused", "accepted", "refused"]


def test_a_second_sender_that_is_refused_beside_one_that_drives_is_one_line(book: Book) -> None:
    for tick in range(100):
        book.hear(10.0 + tick * 0.05)
        book.hear(10.0 + tick * 0.05, refusal="another drives", sender=OTHER)
    assert [(line["event"], line["sender"]) for line in book.lines()] == [
        ("accepted", "c0ffee"),
        ("refused", "beef"),
    ]


def test_who_carries_no_proof_has_no_name(book: Book) -> None:
    book.hear(10.0, acted=None, refusal="it carries no proof", sender=None)
    assert book.lines()[0]["sender"] == ""


def test_all_keeps_every_command(tmp_path: Path) -> None:
    book = Book(tmp_path, "all")
    for tick in range(30):
        book.hear(10.0 + tick * 0.01, acted=float(tick // 10), refusal="no" if tick == 29 else None)
    events = book.events()
    assert [event for event in events if event != "more"] == (
        ["accepted"] * 10 + ["act"] + ["accepted"] * 9 + ["act"] + ["accepted"] * 8 + ["refused"]
    )


def test_an_event_is_kept_with_its_values(book: Book, clock: Clock) -> None:
    book.journal.event("stop", by="a teacher", why="wheels off")
    (line,) = book.lines()
    assert (line["event"], line["by"], line["why"], line["at"]) == (
        "stop",
        "a teacher",
        "wheels off",
        round(clock.now(), 3),
    )


def test_off_keeps_nothing_and_makes_no_folder(tmp_path: Path) -> None:
    book = Book(tmp_path / "state", "off")
    book.hear(10.0)
    book.journal.event("start")
    book.journal.close()
    assert not (tmp_path / "state").exists()


def test_a_journal_that_cannot_be_kept_is_one_warning(tmp_path: Path) -> None:
    (tmp_path / "state").write_text("a file")
    book = Book(tmp_path / "state")
    for tick in range(10):
        book.hear(10.0 + tick, acted=float(tick))
    book.journal.close()
    (warning,) = book.warnings
    assert warning.startswith(f"the journal cannot be kept: {tmp_path}/state/journal.jsonl: ")


def test_a_disk_that_fills_up_is_one_warning(tmp_path: Path) -> None:
    (tmp_path / "journal.jsonl").symlink_to("/dev/full")
    book = Book(tmp_path)
    assert not book.warnings
    book.hear(10.0)
    book.journal.close()
    assert book.warnings == [f"the journal cannot be kept: {tmp_path}/journal.jsonl: No space left on device"]
