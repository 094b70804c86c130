"""Who of the robot's own processes hears what, and in which order."""

from collections.abc import Callable
from typing import Any

import pytest

from zteleop.bus.door.hub import Hub
from zteleop.bus.session import Sample
from zteleop.errors import BusError

KEY = "robot/a/pwm/keyboard"


class Zenoh:
    def __init__(self) -> None:
        self.hearers: dict[str, list[Callable[[Sample], None]]] = {}

    def hear(self, key: str, passes: Callable[[Sample], None]) -> Any:
        if not key:
            raise BusError("no key")
        self.hearers.setdefault(key, []).append(passes)
        return type("Declared", (), {"undeclare": lambda it: self.hearers[key].remove(passes)})()

    def say(self, key: str = KEY) -> None:
        for passes in self.hearers.get(key, []):
            passes(Sample(key, b"", ""))


@pytest.fixture
def zenoh() -> Zenoh:
    return Zenoh()


@pytest.fixture
def hub(zenoh: Zenoh) -> Hub:
    return Hub(zenoh)  # type: ignore[arg-type]


def test_who_acts_on_the_newest_is_told_first_whenever_he_came(hub: Hub, zenoh: Zenoh) -> None:
    told: list[str] = []
    for name, depth in (("watchdog", 500), ("black box", 500), ("actuator", 100)):
        hub.hear(KEY, depth, lambda sample, name=name: told.append(name))
    zenoh.say()
    assert told == ["actuator", "watchdog", "black box"]


def test_zenoh_hands_over_once_for_all_of_them(hub: Hub, zenoh: Zenoh) -> None:
    ears = [hub.hear(KEY, depth, lambda sample: None) for depth in (1, 2, 3)]
    hub.hear("robot/a/stop", 1, lambda sample: None)
    assert [len(zenoh.hearers[key]) for key in (KEY, "robot/a/stop")] == [1, 1]
    for ear in ears:
        assert len(zenoh.hearers[KEY]) == 1
        ear.undeclare()
    assert zenoh.hearers[KEY] == []
    hub.hear(KEY, 1, lambda sample: None)
    assert len(zenoh.hearers[KEY]) == 1, "and once more for who comes later"


def test_who_has_left_hears_no_more_and_may_come_again(hub: Hub, zenoh: Zenoh) -> None:
    told: list[str] = []
    first = hub.hear(KEY, 1, lambda sample: told.append("first"))
    hub.hear(KEY, 1, lambda sample: told.append("second"))
    first.undeclare()
    zenoh.say()
    assert told == ["second"]
    hub.hear(KEY, 1, lambda sample: told.append("first again"))
    zenoh.say()
    assert told == ["second", "second", "first again"]


def test_a_key_that_zenoh_does_not_take_is_heard_by_nobody(hub: Hub, zenoh: Zenoh) -> None:
    with pytest.raises(BusError):
        hub.hear("", 1, lambda sample: None)
    hub.hear(KEY, 1, lambda sample: None)
    assert list(zenoh.hearers) == [KEY]
