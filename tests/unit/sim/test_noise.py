import msgspec
import pytest

from zteleop.sim.noise import LEVELS, NONE, Noise


def test_the_levels_rise_and_the_first_is_exact() -> None:
    assert list(LEVELS) == ["none", "low", "high"]
    assert LEVELS["none"] == NONE == Noise()
    for low, high in zip(*(msgspec.structs.astuple(LEVELS[name]) for name in ("low", "high")), strict=True):
        assert 0 < low < high


@pytest.mark.parametrize(
    ("noise", "moves"),
    [(NONE, False), (Noise(range=0.1), False), (Noise(way=0.1), True), (Noise(drift=0.1), True)],
)
def test_it_says_whether_odometry_is_more_than_exact(noise: Noise, moves: bool) -> None:
    assert noise.moves is moves


@pytest.mark.parametrize("value", ["-0.1", "nan", "2.0", '"much"'])
def test_impossible_noise_is_refused(value: str) -> None:
    with pytest.raises(msgspec.ValidationError, match=r"\$\.way"):
        msgspec.convert(msgspec.toml.decode(f"way = {value}"), Noise)
