import pytest

from zteleop.recording import amounts


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (0, "0 bytes"),
        (999, "999 bytes"),
        (1000, "1.0 kB"),
        (999_949, "999.9 kB"),
        (999_960, "1.0 MB"),
        (5_234_000, "5.2 MB"),
        (10**9, "1.0 GB"),
        (10**16, "10000.0 TB"),
    ],
)
def test_sizes(number: int, text: str) -> None:
    assert amounts.size(number) == text


@pytest.mark.parametrize(
    ("ns", "text"),
    [
        (0, "0.000 s"),
        (2_304_000_000, "2.304 s"),
        (59_999_900_000, "60.000 s"),
        (62_300_000_000, "1 min 2.3 s"),
        (3599_990_000_000, "1 h 0 min 0 s"),
        (7385_000_000_000, "2 h 3 min 5 s"),
        (2**64 - 1, "5124095 h 34 min 34 s"),
    ],
)
def test_spans(ns: int, text: str) -> None:
    assert amounts.span(ns) == text


@pytest.mark.parametrize(
    ("ns", "text"),
    [
        (0, "1970-01-01 00:00:00.000 UTC"),
        (1_763_801_462_123_999_999, "2025-11-22 08:51:02.123 UTC"),
        (2**64 - 1, "2554-07-21 23:34:33.709 UTC"),
    ],
)
def test_moments(ns: int, text: str) -> None:
    assert amounts.moment(ns) == text


def test_counts() -> None:
    assert (amounts.count(1, "message"), amounts.count(2, "message")) == ("1 message", "2 messages")
