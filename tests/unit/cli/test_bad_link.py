import argparse

import pytest

from zteleop.cli import _bad_link


def parsed(*typed: str) -> argparse.Namespace:
    parser = argparse.ArgumentParser(exit_on_error=False)
    _bad_link.add(parser, "it")
    return parser.parse_args(typed)


@pytest.mark.parametrize(("text", "share"), [("5%", 0.05), ("0.05", 0.05), ("0", 0.0), ("12.5%", 0.125)])
def test_a_share_is_typed_as_people_do(text: str, share: float) -> None:
    assert parsed("--loss", text).loss == pytest.approx(share)


@pytest.mark.parametrize("text", ["100%", "1", "-1%", "some", "%", "nan"])
def test_all_of_it_more_and_what_is_none_is_refused(text: str) -> None:
    with pytest.raises(argparse.ArgumentError, match=r"expected (a share, such as 5%|less than all of it)"):
        parsed(f"--loss={text}")


@pytest.mark.parametrize(
    "typed", [(), ("--latency", "200ms"), ("--loss", "5%"), ("--latency", "0.1s", "--loss", "0.5")]
)
def test_who_is_started_gets_the_same_link(typed: tuple[str, ...]) -> None:
    asked = parsed(*typed)
    assert parsed(*_bad_link.as_typed(asked)) == asked
