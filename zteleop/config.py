"""config.toml: the contents page of every other module's settings, and where it is found."""

import contextlib
import os
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any, Literal

import msgspec
from msgspec import Struct, field

from zteleop.bus.names import chunk, robot_name
from zteleop.bus.settings import BusSettings
from zteleop.bus.topics import topic_of
from zteleop.control.motion.dead_reckoning import OdometrySettings
from zteleop.control.settings import DriveSettings
from zteleop.control.stick import Speeds
from zteleop.drivers import DRIVERS, settings_kind, settings_of, tick_us
from zteleop.drivers.simulated import default_path
from zteleop.errors import ConfigError
from zteleop.inputs.gamepad_map import GamepadSettings
from zteleop.inputs.keymap import bindings, switches
from zteleop.inputs.levers import Steps
from zteleop.machine.signals import sheltered

LONGEST = 2**20
"""bytes of a file: /dev/zero has no end, and half of a file may be another calibration"""
MOST = 20
"""mistakes of a file that are told at once"""


class Config(Struct, frozen=True, forbid_unknown_fields=True):
    """Everything that can be set; without a file, a simulated car with Donkeycar's calibration."""

    robot: str | None = None
    """its name on the bus; without one, a name of its own is made and kept"""
    driver: str = "simulated"
    bus: BusSettings = BusSettings()
    drive: DriveSettings = field(default_factory=DriveSettings)
    speeds: Speeds = Speeds()
    """of a full stick, for inputs that drive while held"""
    steps: Steps = Steps()
    """of a key press, for inputs that drive in steps"""
    keymap: str = "all"
    """of the keyboard; `zteleop keyboard --help` names them"""
    keys: dict[str, str] = {}
    """key -> action, beside those of the keymap"""
    gamepad: GamepadSettings = GamepadSettings()
    """which control of a pad does what; `zteleop gamepad --learn` finds it out"""
    odometry: OdometrySettings = OdometrySettings()
    """of `zteleop odometry`, which counts where a robot should be"""
    journal: Literal["acts", "all", "off"] = "acts"
    """what a robot keeps of the commands on its disk: who acted, every one, nothing"""
    blackbox: bool = True
    """a robot keeps the last minute of every topic, and writes it when it stops, fails or crashes"""
    launch: dict[str, str] = {}
    """name -> what `zteleop up` starts under it: a verb with its options, or any other program"""
    drivers: dict[str, dict[str, Any]] = {}
    """settings of each driver by name"""

    def __post_init__(self) -> None:
        if self.robot is not None:
            robot_name(self.robot)
        for switch in switches(bindings(self.keys, self.keymap)):
            if types := topic_of(switch).types:
                raise ConfigError(f"no switch can be called {switch}: that is a topic of {types[0].__name__}")
        for name in self.launch:
            chunk(name, "a name in [launch]")
        for source in self.drive.sources:
            chunk(source, "a source")
        for name, settings in {self.driver: {}, **self.drivers}.items():
            settings_of(name, settings)

    @property
    def tick_us(self) -> float:
        """Length of a count of its chip, in us."""
        return tick_us(self.driver, self.drivers.get(self.driver, {}))

    def driver_settings(self, driver: str, robot: str) -> dict[str, Any]:
        """Return a driver's settings; a simulated chip lies in a file named after its robot."""
        place = {"path": default_path(robot)} if driver == "simulated" else {}
        return place | self.drivers.get(driver, {})


def load(path: Path | None = None) -> Config:
    """Return the settings of a file, by default of the first that is found.

    Raises ConfigError with the place and the reason of a mistake.
    """
    path = path or found()
    if path is None:
        return Config()
    try:
        with path.open("rb") as file:
            text = file.read(LONGEST + 1)
    except OSError as error:
        raise ConfigError(f"cannot read {path}: {error.strerror}") from None
    return parse(text, str(path))


def parse(text: bytes, name: str = "settings") -> Config:
    """Return the settings a TOML text makes; raises ConfigError, a line for each mistake."""
    if len(text) > LONGEST:
        raise ConfigError(f"{name}: expected at most {LONGEST} bytes of settings, found more")
    try:
        values = msgspec.toml.decode(text)
        with sheltered():
            return msgspec.convert(values, Config)
    except msgspec.ValidationError as error:
        raise ConfigError(_mistakes(text.decode(), values, name) or f"{name}: {error}") from None
    except (msgspec.DecodeError, ValueError, RecursionError) as error:
        from zteleop.text.not_toml import explained  # only where it is none

        place, words = explained(str(error), text.decode(errors="replace"))
        where = ":".join(filter(None, (name, place)))
        more = "what else is wrong shows once this is right"
        raise ConfigError(f"{where}: not TOML: {words}; {more}") from None


def places() -> Iterator[Path]:
    """Yield where a config file is looked for, in order."""
    yield Path("config.toml")
    yield _xdg("XDG_CONFIG_HOME", ".config") / "config.toml"


def found() -> Path | None:
    """Return the first config file there is, if any."""
    return next((place for place in places() if os.path.isfile(place)), None)


def own_name() -> str:
    """Return this machine's robot name, made and kept at the first call."""
    file = _xdg("XDG_STATE_HOME", ".local/state") / "robot"
    with contextlib.suppress(OSError, ConfigError, UnicodeDecodeError):
        return _kept_name(file)
    try:
        return _make_name(file)
    except OSError as error:
        raise ConfigError(
            f"cannot keep a robot's name in {file}: {error.strerror}; say --robot NAME"
        ) from None


def state_folder(robot: str) -> Path:
    """Return where what a robot must not forget is kept across restarts."""
    return _xdg("XDG_STATE_HOME", ".local/state") / "robots" / robot_name(robot)


def _kept_name(file: Path) -> str:
    return robot_name(file.read_text().strip())


def _new_name() -> str:
    return f"car-{os.urandom(2).hex()}"


def _make_name(file: Path) -> str:
    """Keep a new name; of two processes that start at once, both get the same."""
    file.parent.mkdir(parents=True, exist_ok=True)
    new = file.with_name(f"robot.{os.getpid()}")
    new.write_text(f"{_new_name()}\n")
    if file.exists():  # and holds no name
        new.replace(file)
    with contextlib.suppress(FileExistsError, FileNotFoundError):
        os.link(new, file)
    new.unlink(missing_ok=True)
    return _kept_name(file)


def _xdg(variable: str, default: str) -> Path:
    folder = os.environ.get(variable)
    try:
        return (Path(folder) if folder else Path.home() / default) / "zteleop"
    except RuntimeError:
        raise ConfigError(f"this user has no home folder; set {variable}") from None


def _mistakes(text: str, values: Any, name: str) -> str:
    """Return in a line each where a file is wrong and what may stand there."""
    from zteleop.text.mistakes import mistakes  # only where there are some
    from zteleop.text.toml_places import place
    from zteleop.text.toml_places import places as places_of

    kinds: dict[tuple[str, ...], Any] = {("drivers", driver): settings_kind(driver) for driver in DRIVERS}
    found = list(islice(mistakes(values, Config, kinds), MOST))
    written, lines = places_of(text), []
    for at, path, words in sorted((place(written, path) or (), path, words) for path, words in found):
        where = ":".join([name, *map(str, at)])
        lines.append(": ".join(filter(None, (where, ".".join(path), words))))
    return "\n".join(lines)
