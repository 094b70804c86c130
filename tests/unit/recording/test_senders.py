"""The sentences themselves are proved in test_timeline."""

import pytest

from zteleop.recording.senders import PAUSE, Sender


@pytest.mark.parametrize(
    ("gaps", "rate"),
    [
        ([], "seldom before"),
        ([0.05] * 9, "20 a second until then"),
        ([0.05, 0.05, 9.0], "20 a second until then"),
        ([5.0], "seldom before"),
        ([0.0, 0.0], "seldom before"),
    ],
)
def test_a_senders_rate_is_its_usual_one(gaps: list[float], rate: str) -> None:
    sender = Sender("keyboard 3f2a")
    sender.gaps.extend(gaps)
    assert sender.rate == rate


def test_a_pause_is_longer_than_two_repeats_and_shorter_than_a_deadline() -> None:
    assert 2 * 0.05 < PAUSE < 0.3
