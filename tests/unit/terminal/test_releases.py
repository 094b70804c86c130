import pytest

from zteleop.terminal.keys import Report
from zteleop.terminal.releases import ASK, OFF, ON, PING, PING_EVERY, SILENT, Releases
from zteleop.testing import FakeTerminal

ATTRIBUTES = Report("attributes")


@pytest.fixture
def terminal() -> FakeTerminal:
    terminal = FakeTerminal()
    terminal.answers = True
    return terminal


@pytest.fixture
def releases(terminal: FakeTerminal) -> Releases:
    releases = Releases(terminal)
    releases.ask(1.0)
    return releases


def hear(releases: Releases, *reports: Report, now: float = 1.0) -> None:
    releases.hear_bytes(now)
    for report in reports:
        releases.hear(report, now)


def test_a_terminal_that_knows_the_protocol_is_told_to_use_it_and_asked_again(
    terminal: FakeTerminal, releases: Releases
) -> None:
    hear(releases, Report("protocol", 0), ATTRIBUTES)
    assert terminal.said == ASK + ON + ASK
    assert not releases.known
    assert not releases.told
    hear(releases, Report("protocol", 15), ATTRIBUTES)
    assert releases.known
    assert releases.told


def test_one_that_does_not_know_it_is_told_nothing(terminal: FakeTerminal, releases: Releases) -> None:
    hear(releases, ATTRIBUTES)
    assert releases.known
    assert not releases.told
    assert terminal.said == ASK


def test_one_that_grants_less_than_it_is_asked_for_tells_no_releases(
    terminal: FakeTerminal, releases: Releases
) -> None:
    hear(releases, Report("protocol", 0), ATTRIBUTES, Report("protocol", 5), ATTRIBUTES)
    assert releases.known
    assert not releases.told
    assert terminal.said.count(ON) == 1


def test_one_that_answers_nothing_is_not_waited_for() -> None:
    releases = Releases(FakeTerminal())
    releases.ask(1.0)
    assert releases.known


def test_after_the_terminal_was_away_nothing_is_told_until_it_says_so(releases: Releases) -> None:
    hear(releases, Report("protocol", 15), ATTRIBUTES, Report("focus", 0))
    releases.ask(9.0)
    assert not releases.told
    assert releases.focused


def test_a_terminal_that_is_there_answers_pings_and_one_that_is_gone_is_silent(
    terminal: FakeTerminal, releases: Releases
) -> None:
    hear(releases, Report("protocol", 15), ATTRIBUTES)
    now = 2.0
    for _ in range(20):
        now += 0.05
        releases.ping(now)
        hear(releases, ATTRIBUTES, now=now)
        assert not releases.is_silent(now)
    assert 0.5 / PING_EVERY <= terminal.said.removeprefix(ASK).count(PING) <= 1.0 / PING_EVERY
    assert not releases.is_silent(now + SILENT * 0.9)
    assert releases.is_silent(now + SILENT * 1.1)


def test_a_terminal_that_tells_no_releases_is_neither_asked_nor_silent(
    terminal: FakeTerminal, releases: Releases
) -> None:
    hear(releases, ATTRIBUTES)
    releases.ping(60.0)
    assert terminal.said == ASK
    assert not releases.is_silent(60.0)


@pytest.mark.parametrize("off", [OFF])
def test_what_is_switched_on_is_what_is_switched_off(off: str) -> None:
    assert "[>15u" in ON
    assert "[<u" in off
    assert "?1004h" in ON
    assert "?1004l" in off
