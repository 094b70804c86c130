from zteleop.messages import Header, LedColor, LightringLeds, Time
from zteleop.sim.create3.lightring import DARK, ORANGE, RED, WHITE, Lightring, own_lights

BLUE = LedColor(0, 0, 255)


def told(override: bool) -> LightringLeds:
    return LightringLeds(Header(Time(0, 0), ""), [BLUE] * 6, override)


def test_it_shows_what_it_is_told_until_that_is_taken_back() -> None:
    ring = Lightring()
    assert ring.show(0.0, 1.0, False, False) == [WHITE] * 6
    ring.hear(told(True))
    assert ring.show(0.0, 0.01, True, True) == [BLUE] * 6
    ring.hear(told(False))
    assert ring.show(0.0, 1.0, False, False) == [WHITE] * 6


def test_below_10_percent_it_pulses_red() -> None:
    assert own_lights(0.1, 0.09, False, True) == [RED] * 6
    assert own_lights(0.6, 0.09, True, False) == [DARK] * 6


def test_below_3_percent_one_red_light_goes_around() -> None:
    seen = [own_lights(step / 10, 0.02, False, False).index(RED) for step in range(6)]
    assert seen == [0, 1, 2, 3, 4, 5]
    assert own_lights(0.0, 0.02, False, False).count(RED) == 1


def test_on_the_dock_it_shows_how_full_it_is() -> None:
    assert own_lights(0.0, 0.5, True, False) == [WHITE] * 3 + [DARK] * 3
    assert own_lights(0.0, 1.0, True, False) == [WHITE] * 6


def test_its_rear_is_orange_where_it_must_not_reverse() -> None:
    assert own_lights(0.0, 1.0, False, True) == [ORANGE, DARK, DARK, DARK, ORANGE, ORANGE]
