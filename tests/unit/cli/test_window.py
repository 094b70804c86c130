import argparse

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.cli._window import Window, add_argument


@given(st.lists(st.floats(-1e6, 1e6), min_size=1), st.integers(1, 5))
def test_the_figures_are_those_of_the_newest(values: list[float], most: int) -> None:
    window = Window(most)
    for value in values:
        window.add(value)
    newest, figures = values[-most:], window.figures
    assert figures
    assert figures.messages == len(newest)
    assert (figures.least, figures.largest) == (min(newest), max(newest))
    assert figures.mean == pytest.approx(sum(newest) / len(newest), abs=1e-6)
    spread = sum((value - figures.mean) ** 2 for value in newest) / len(newest)
    assert figures.deviation**2 == pytest.approx(spread, abs=1e-3)


def test_of_nothing_there_are_no_figures() -> None:
    assert Window().figures is None


@pytest.mark.parametrize("text", ["0", "-1", "ten", "1000001"])
def test_a_window_of_no_messages_is_refused(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    parser = argparse.ArgumentParser()
    add_argument(parser)
    with pytest.raises(SystemExit):
        parser.parse_args(["-w", text])
    assert f"expected 1 to 1000000 messages, found {text}" in capsys.readouterr().err
