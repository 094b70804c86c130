"""What a verb that listens says of silence."""

from itertools import pairwise

import pytest
from unit.bus.fakes import Session, put

from zteleop.bus import presence
from zteleop.bus.names import Name
from zteleop.cli._listening import GONE_AFTER, LOOK_AGAIN, MOST_COMPLAINTS, Complaints, Listening
from zteleop.messages import Odometry
from zteleop.testing import Clock

ODOM = Name("abe", "odom")


def test_each_sentence_is_told_once_and_of_many_the_first(capsys: pytest.CaptureFixture[str]) -> None:
    complaints = Complaints()
    for number in range(3 * MOST_COMPLAINTS):
        complaints.tell(f"no {number % 150}\x1b")
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == MOST_COMPLAINTS
    assert lines[0] == "no 0\\u001b"


@pytest.mark.parametrize("publishes", [True, False])
def test_what_nobody_says_any_more_is_told_once_and_a_pause_is_not(
    clock: Clock, capsys: pytest.CaptureFixture[str], publishes: bool
) -> None:
    token = presence.endpoint_key(ODOM, "pub", "sim", [Odometry])
    session = Session([token] if publishes else [])
    ears = Listening("echo", session)  # type: ignore[arg-type]
    session.subscribe(ODOM.key, 1).samples.append(put(b"{}", key=ODOM.key))
    ears.hear(ODOM, lambda arrival: ears.loop.stop())
    ears.loop.run()
    ears._notice_end()
    assert capsys.readouterr().err == ""
    clock.pass_by(GONE_AFTER + 0.5)
    ears._notice_end()
    ears._notice_end()
    told = (
        ""
        if publishes
        else ("zteleop echo: abe/odom has been silent for 2 s, and nobody publishes it any more\n")
    )
    assert capsys.readouterr().err == told
    clock.pass_by(LOOK_AGAIN + 1)
    ears._notice_end()
    assert capsys.readouterr().err == ""
    ears.close()


def test_where_somebody_only_pauses_it_does_not_ask_everybody_again_and_again(clock: Clock) -> None:
    session = Session([presence.endpoint_key(ODOM, "pub", "sim", [Odometry])])
    ears = Listening("echo", session)  # type: ignore[arg-type]
    session.subscribe(ODOM.key, 1).samples.append(put(b"{}", key=ODOM.key))
    ears.hear(ODOM, lambda arrival: ears.loop.stop())
    ears.loop.run()
    looks: list[float] = []
    there = presence.endpoints(session)  # type: ignore[arg-type]
    ears.endpoints = lambda: looks.append(clock.time) or there  # type: ignore[func-returns-value,method-assign]
    for _ in range(20):
        clock.pass_by(1.0)
        ears._notice_end()
    assert [round(later - sooner) for sooner, later in pairwise(looks)] == [11]
    ears.close()
