import argparse
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TypeVar

from zteleop import config
from zteleop.bus.names import robot_name
from zteleop.control.vehicles import VEHICLES
from zteleop.drivers import DRIVERS
from zteleop.errors import ConfigError, nearest
from zteleop.text.first_config import WHEELS, Answers, first_config
from zteleop.text.quantity import quantity

EXAMPLES = (
    "zteleop init first.toml --yes",
    "zteleop init second.toml --yes",
)
CHANNELS = 16
"""of a PCA9685"""
LENGTHS = {"car": ("m between its axles", "25cm"), "tank": ("m between its wheels", "20cm")}
I2C = Path("/dev/i2c-1")
T = TypeVar("T")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "file", metavar="FILE", nargs="?", type=Path, default=Path("config.toml"), help="default: config.toml"
    )
    parser.add_argument("-y", "--yes", action="store_true", help="ask nothing: take what stands in brackets")


def run(arguments: argparse.Namespace) -> None:
    file: Path = arguments.file
    if file.exists():
        raise ConfigError(f"{file} is there already, and stays; zteleop check says what it makes of a robot")
    answers = Questions(arguments.yes).answers()
    text = first_config(answers)
    config.parse(text.encode(), str(file))  # never a file that the next verb refuses
    try:
        with file.open("x", encoding="utf-8") as out:
            out.write(text)
    except OSError as error:
        raise ConfigError(f"cannot write {file}: {error.strerror}") from None
    print(told(file, answers))


def told(file: Path, answers: Answers) -> str:
    """Return what there is now, and what to type next."""
    known = file == Path("config.toml")
    steps = {
        "zteleop check" if known else f"zteleop check {file}": "says what it makes of a robot",
        "zteleop actuator" if known else f"zteleop actuator --config {file}": f"starts {answers.robot}",
        "zteleop keyboard": "in another terminal drives it",
    }
    width = max(map(len, steps)) + 3
    lines = [f"{file} is written", *(f"  {command:{width}}{does}" for command, does in steps.items())]
    if answers.driver != "simulated":
        lines.append("lift its wheels first: the ends of its servos are the usual ones, yours may be others")
    return "\n".join(lines)


class Questions:
    """Five of them, each with an answer in brackets that Enter takes."""

    def __init__(self, takes_all: bool) -> None:
        self._takes_all = takes_all

    def answers(self) -> Answers:
        """Ask; a wrong answer is told, and asked for again."""
        robot = self._ask("what is the robot called?", config.own_name(), robot_name)
        vehicle = self._ask("what is it: car or tank?", "car", lambda said: one_of(said, WHEELS))
        driver = self._ask(
            f"which chip makes its pulses: {', '.join([*DRIVERS][:-1])} or {[*DRIVERS][-1]}?",
            "pca9685" if I2C.exists() else "simulated",
            lambda said: one_of(said, DRIVERS),
        )
        first, second = WHEELS[vehicle]
        servos = VEHICLES[vehicle].servos
        usual = f"{servos[first].channel} {servos[second].channel}"
        channels = self._ask(f"on which channels are {first} and {second}?", usual, two_channels)
        what, length = LENGTHS[vehicle]
        return Answers(robot, vehicle, driver, channels, self._ask(f"how many {what}?", length, some_length))

    def _ask(self, question: str, usual: str, read: Callable[[str], T]) -> T:
        if self._takes_all:
            return read(usual)
        while True:
            try:
                said = input(f"{question} [{usual}] ").strip()
            except EOFError:
                print(file=sys.stderr)
                raise ConfigError("the questions were not answered; nothing is written") from None
            try:
                return read(said or usual)
            except ConfigError as error:
                print(f"  {error}", file=sys.stderr)


def one_of(said: str, choices: Iterable[str]) -> str:
    """Return one of some words; raises ConfigError for any other."""
    if said not in choices:
        raise ConfigError(f"expected {' or '.join(choices)}, found {said!r}; {nearest(said, choices)}")
    return said


def two_channels(said: str) -> tuple[int, int]:
    """Return two channels of a chip; raises ConfigError for what is none, and for one that is told twice."""
    words = said.replace(",", " ").split()
    numbers = [int(word) for word in words if word.isdecimal() and int(word) < CHANNELS]
    if len(words) != 2 or len(numbers) != 2 or numbers[0] == numbers[1]:
        raise ConfigError(
            f"expected two different channels from 0 to {CHANNELS - 1}, such as 0 1, found {said!r}"
        )
    return numbers[0], numbers[1]


def some_length(said: str) -> float:
    """Return a length in m; raises ConfigError for none, and for one that no robot has."""
    if not 0.01 <= (length := quantity(said, "length")) <= 10:
        raise ConfigError(f"expected a length between 1cm and 10m, found {said}")
    return length
