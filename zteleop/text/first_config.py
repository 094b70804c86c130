"""A robot's first config.toml, made of what its owner has answered."""

from typing import NamedTuple

from zteleop.control.vehicles import VEHICLES

SERVO = """\
[drive.servos.{name}]
channel = {channel}
min_us = {min_us:g}{min_says}
neutral_us = {neutral_us:g}
max_us = {max_us:g}{max_says}
"""
SAYS = {
    "throttle": ("full reverse", "full forward"),
    "steering": ("full right", "full left"),
    "left": ("full reverse", "full forward"),
    "right": ("full reverse", "full forward"),
}


class Answers(NamedTuple):
    """What a robot is; lengths in m."""

    robot: str
    vehicle: str
    driver: str
    channels: tuple[int, int]
    """of the chip, in the order of `WHEELS`"""
    length: float
    """between the axles of a car, or the wheels of a tank"""


WHEELS = {"car": ("throttle", "steering"), "tank": ("left", "right")}


def first_config(answers: Answers) -> str:
    """Return the text of a file: what was answered, and what is most often changed next."""
    mixer, servos, _ = VEHICLES[answers.vehicle]
    length = "wheelbase" if answers.vehicle == "car" else "track"
    parts = [
        f"""\
# Settings of {answers.robot}; `zteleop check` says what they make. All that can be set:
# the config.toml that comes with zteleop, or schemas/config.json.

robot = "{answers.robot}"
driver = "{answers.driver}"

[drive.mixer]
kind = "{mixer.kind}"
{length} = {answers.length:g}{" " * 12}# m
max_speed = {mixer.max_speed:g}{" " * 12}# m/s at full throttle; measure it
"""
    ]
    for name, channel in zip(WHEELS[answers.vehicle], answers.channels, strict=True):
        servo = servos[name]
        least, most = (f"{' ' * 12}# {words}" for words in SAYS[name])
        text = SERVO.format(
            name=name,
            channel=channel,
            min_us=servo.min_us,
            neutral_us=servo.neutral_us,
            max_us=servo.max_us,
            min_says=least,
            max_says=most,
        )
        parts.append(f"{text}dead_zone_us = {servo.dead_zone_us:g}\n" if servo.dead_zone_us else text)
    return "\n".join(parts)
