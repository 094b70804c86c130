from typing import Any

import msgspec
import pytest

from zteleop.messages import Int16MultiArray, Log, Message, MultiArrayLayout, Pwm, Time


@pytest.mark.parametrize(
    ("kind", "values"),
    [
        (Time, {"sec": 2**31, "nanosec": 0}),
        (Time, {"sec": -(2**31) - 1, "nanosec": 0}),
        (Time, {"sec": 0, "nanosec": -1}),
        (Time, {"sec": 0, "nanosec": 2**32}),
        (Pwm, {"steering_ticks": 2**15, "throttle_ticks": 0}),
        (Pwm, {"steering_ticks": 0, "throttle_ticks": -(2**15) - 1}),
        (Int16MultiArray, {"layout": msgspec.to_builtins(MultiArrayLayout.zero()), "data": [0, 2**15]}),
        (Log, msgspec.to_builtins(Log.zero()) | {"level": 256}),
    ],
)
def test_a_number_that_ros_could_not_hold_is_refused(kind: type[Message], values: dict[str, Any]) -> None:
    with pytest.raises(msgspec.ValidationError, match="Expected `int`"):
        msgspec.convert(values, kind)


@pytest.mark.parametrize("ticks", [-(2**15), 2**15 - 1])
def test_the_ends_are_inclusive(ticks: int) -> None:
    assert msgspec.convert({"steering_ticks": ticks, "throttle_ticks": ticks}, Pwm) == Pwm(ticks, ticks)
