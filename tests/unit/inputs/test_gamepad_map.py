import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.errors import ConfigError
from zteleop.inputs.gamepad_map import Control, GamepadSettings, rescale


def test_without_settings_it_is_the_left_stick_and_lb() -> None:
    assert GamepadSettings().controls == {
        "forward": Control("ABS_Y", -1),
        "turn": Control("ABS_X", -1),
        "deadman": Control("BTN_TL"),
        "turbo": Control("BTN_TR"),
        "stop": Control("BTN_EAST"),
        "release": Control("BTN_START"),
    }


def test_what_is_left_empty_is_no_control() -> None:
    assert set(GamepadSettings(turbo="", stop="", release="").controls) == {"forward", "turn", "deadman"}


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"forward": "ABS_YY"}, "expected an axis for forward, found 'ABS_YY'; did you mean ABS_Y"),
        ({"forward": "BTN_TL"}, "expected an axis for forward, found 'BTN_TL'"),
        ({"turn": ""}, "expected an axis for turn, found ''"),
        ({"deadman": ""}, "expected a button for deadman, found ''"),
        ({"deadman": "btn_t"}, "found 'btn_t'; did you mean BTN_TR or BTN_TL"),
        ({"stop": "-BTN_EAST"}, "expected a button for stop, found '-BTN_EAST'"),
        ({"turn": "ABS_Y"}, "turn and forward are both ABS_Y; each wants its own"),
        ({"stop": "BTN_TL"}, "stop and deadman are both BTN_TL"),
        ({"turbo": "ABS_X"}, "turbo and turn are both ABS_X"),
    ],
)
def test_a_bad_mapping_is_refused_in_a_sentence(settings: dict[str, str], words: str) -> None:
    with pytest.raises(ConfigError) as refusal:
        GamepadSettings(**settings)
    assert words in str(refusal.value)


def test_both_ways_of_a_hat_are_two_buttons() -> None:
    controls = GamepadSettings(stop="ABS_HAT0Y", release="-ABS_HAT0Y").controls
    assert controls["stop"].pressed({"ABS_HAT0Y": 1.0})
    assert not controls["stop"].pressed({"ABS_HAT0Y": -1.0})
    assert controls["release"].pressed({"ABS_HAT0Y": -1.0})


def test_the_kernels_first_names_are_known() -> None:
    assert GamepadSettings(stop="BTN_X").controls["stop"] == Control("BTN_NORTH")
    with pytest.raises(ConfigError, match="release and stop are both BTN_EAST"):
        GamepadSettings(release="BTN_B")


def test_a_control_that_is_not_there_is_at_rest() -> None:
    assert Control("BTN_TL").of({}) == 0.0
    assert not Control("BTN_TL").pressed({})


@pytest.mark.parametrize(("name", "label"), [("BTN_TL", "LB"), ("BTN_PINKIE", "BTN_PINKIE")])
def test_a_control_is_called_as_it_is_printed(name: str, label: str) -> None:
    assert Control(name).label == label


@pytest.mark.parametrize(
    ("value", "expected"), [(0.1, 0.0), (-0.1, 0.0), (0.55, 0.5), (-0.55, -0.5), (1.0, 1.0), (-1.0, -1.0)]
)
def test_beyond_the_dead_zone_a_stick_goes_from_nothing_to_full(value: float, expected: float) -> None:
    assert rescale(value, 0.1) == pytest.approx(expected)


@given(st.floats(-1, 1), st.floats(0, 0.9))
def test_a_rescaled_stick_is_in_range_and_never_turned_round(value: float, deadzone: float) -> None:
    scaled = rescale(value, deadzone)
    assert -1 <= scaled <= 1
    assert scaled * value >= 0
    assert abs(scaled) <= abs(value) + 1e-9
