"""The page of time is the one that people read, and its lines leave each other the time they need."""

import re
from pathlib import Path

from zteleop.bus.topics import TOPICS
from zteleop.control import deadlines
from zteleop.control.deadlines import Deadlines, table
from zteleop.control.settings import SOURCES

DOCS = Path(__file__).parents[3] / "docs"
BEATS = 3
"""that may be late or lost in a row without anybody's noticing"""


def rows(page: str, heading: str) -> list[list[str]]:
    """Return the lines of the first table after a heading."""
    part = (DOCS / page).read_text().split(heading, 1)[1]
    lines = re.search(r"^(\|.*\n)+", part, re.MULTILINE)
    assert lines
    return [[cell.strip() for cell in line.strip("|\n").split(" | ")] for line in lines[0].splitlines()[2:]]


def test_the_table_of_deadlines_is_the_one_in_the_documents() -> None:
    assert rows("safety.md", "## Deadlines") == [list(line) for line in table(Deadlines())]


def test_each_topic_is_said_as_often_as_the_documents_say() -> None:
    told = {row[0].strip("`").removesuffix("/<source>"): row[-1] for row in rows("bus.md", "# What travels")}
    for topic in TOPICS.values():
        if topic.every:
            assert told[topic.name].startswith(f"{1 / topic.every:g} Hz"), topic.name


def test_what_is_said_in_time_is_heard_in_time() -> None:
    said = TOPICS["cmd_vel"].every
    assert all(BEATS * said <= source.silence for source in SOURCES.values())
    assert BEATS * TOPICS["beat"].every <= Deadlines().max_age
    assert BEATS * TOPICS["beat"].every <= deadlines.DEAF_AFTER
    assert BEATS * deadlines.STEP_EVERY <= Deadlines().late_step <= deadlines.ACTUATOR_SILENCE


def test_whoever_guards_waits_for_longer_than_whom_he_guards_may_need() -> None:
    assert Deadlines().late_step + deadlines.STEP_EVERY < deadlines.WATCHDOG_SILENCE
    assert deadlines.GRACE > BEATS * deadlines.STEP_EVERY
    assert Deadlines().stand_still <= Deadlines().link_loss
    assert max(source.silence for source in SOURCES.values()) < Deadlines().link_loss
    assert Deadlines().link_loss < Deadlines().operator
