"""Any bytes at all, and bytes that are nearly right, into everything that takes bytes."""

from pathlib import Path

import pytest
from fuzz.reading import corpus
from fuzz.targets import TARGETS
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

TIMES = {"chip": 40, "keyboard": 60, "values": 60}
"""How often, where each time costs more."""
PIECES = st.one_of(
    st.binary(max_size=8),
    st.integers(-(2**65), 2**65).map(lambda number: str(number).encode()),
    st.sampled_from(
        [b"", b"\0", b"\xff", b"\x1b[2J", b"*", b"NaN", b"1e999", b"null", b"\n", b'"', b"{", b"["]
    ),
    st.text(max_size=4).map(str.encode),
)


def mutants(target: str) -> st.SearchStrategy[bytes]:
    """Return files of the corpus with a piece replaced, twice, or followed by the end of another."""
    files = st.sampled_from([file.read_bytes() for file in corpus(target)])
    cuts = st.tuples(st.floats(0, 1), st.floats(0, 1)).map(sorted)
    replaced = st.builds(replace, files, cuts, PIECES)
    return st.one_of(
        replaced, st.builds(replace, replaced, cuts, PIECES), st.builds(splice, files, files, cuts)
    )


def replace(data: bytes, cut: list[float], piece: bytes) -> bytes:
    start, end = (round(place * len(data)) for place in cut)
    return data[:start] + piece + data[end:]


def splice(one: bytes, other: bytes, cut: list[float]) -> bytes:
    return one[: round(cut[0] * len(one))] + other[round(cut[1] * len(other)) :]


@pytest.mark.parametrize("target", TARGETS)
def test_any_bytes(target: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    @settings(
        max_examples=TIMES.get(target, 120),
        deadline=None,
        database=None,
        suppress_health_check=[HealthCheck.function_scoped_fixture],
    )
    @given(st.binary(max_size=300) | st.text(max_size=100).map(str.encode) | mutants(target))
    def attack(data: bytes) -> None:
        TARGETS[target](data)

    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    attack()
