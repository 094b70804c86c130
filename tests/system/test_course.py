"""What the course on the Create 3 has people type, beside a simulated car."""

import time

import pytest
from rig import NEUTRAL, Rig, every, repeating, until

from zteleop.messages import InterfaceButtons

TYPE = "geometry_msgs/msg/TwistStamped"


def values(linear: float, angular: float) -> str:
    return (
        "{header: {stamp: {sec: 0, nanosec: 0}, frame_id: ''}, twist: {linear: "
        f"{{x: {linear}, y: 0.0, z: 0.0}}, angular: {{x: 0.0, y: 0.0, z: {angular}}}}}}}"
    )


def test_a_command_a_second_goes_and_stops_and_ten_a_second_go_on(rig: Rig) -> None:
    rig.actuator()
    pub = rig.join("pub", "-r", "1", "cmd_vel_stamped", TYPE, values(0.3, 0.0))
    for _ in range(2):
        until(lambda: rig.ticks[1] > NEUTRAL[1], "motion")
        until(lambda: rig.ticks == NEUTRAL, "rest, as it hears nothing for half a second")
    assert "a robot obeys each for 0.5 s, and stops in between" in pub.text
    pub.close()
    rig.join("pub", "-r", "10", "cmd_vel_stamped", TYPE, values(0.3, 0.0))
    until(lambda: rig.ticks[1] > NEUTRAL[1], "motion")
    at_rest = sum(rig.ticks == NEUTRAL for _ in every(0.01, 150))
    assert at_rest < 30, "but for a moment of the machine's own"


@pytest.mark.parametrize(("angular", "left"), [(0.5, True), (-0.5, False)])
def test_a_positive_turn_is_to_the_left(rig: Rig, angular: float, left: bool) -> None:
    rig.actuator()
    rig.join("pub", "-r", "10", "cmd_vel_stamped", TYPE, values(0.3, angular))
    until(lambda: rig.ticks[0] not in (None, NEUTRAL[0]), "the wheels to one side")
    assert (rig.ticks[0] > NEUTRAL[0]) is left


def test_a_button_that_is_held_is_echoed_as_yaml_with_its_growing_time(rig: Rig) -> None:
    rig.actuator()
    publisher = rig.node("robot").publisher("interface_buttons", InterfaceButtons)
    began = time.time()

    def say() -> None:
        message = InterfaceButtons.zero()
        message.button_1.is_pressed = True
        message.button_1.last_start_pressed_time.sec = int(began)
        message.button_1.last_pressed_duration.nanosec = int((time.time() - began) % 1 * 1e9)
        publisher.publish(message)

    echo = rig.join("topic", "echo", f"/{rig.robot}/interface_buttons")
    with repeating(say, 0.1):
        until(lambda: echo.text.count("\n---") >= 2, "two messages")
    first, second = echo.text.split("\n---")[:2]
    for part in (
        "button_1:",
        "button_power:",
        "button_2:",
        "last_start_pressed_time:",
        "last_pressed_duration:",
    ):
        assert part in first
    assert first.count("is_pressed: true") == 1
    assert first != second
