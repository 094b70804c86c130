"""Scenes by name, or by file."""

from importlib.resources import files
from pathlib import Path

from zteleop.errors import ConfigError, nearest
from zteleop.sim.scene import LONGEST, Scene, parse

FOLDER = files("zteleop.sim") / "scenes"


def names() -> list[str]:
    """Return which scenes come along."""
    return sorted(Path(file.name).stem for file in FOLDER.iterdir() if file.name.endswith(".toml"))


def find(name: str) -> Scene:
    """Return a scene, of those that come along or of a file.

    Raises ConfigError for a name that is none, and for a file that is no scene.
    """
    if name in names():
        text = (FOLDER / f"{name}.toml").read_bytes()
    elif name.endswith(".toml") or "/" in name:
        try:
            with open(name, "rb") as file:
                text = file.read(LONGEST + 1)
        except OSError as error:
            raise ConfigError(f"cannot read {name}: {error.strerror}") from None
    else:
        raise ConfigError(f"no scene {name!r}, nor a file such as ./room.toml; {nearest(name, names())}")
    try:
        return parse(text)
    except ConfigError as error:
        raise ConfigError(f"{name}: {error}") from None
