"""Whom `zteleop doctor` looks at, and what it finds."""

from typing import NamedTuple

from zteleop.config import Config


class Patient(NamedTuple):
    """What is looked at."""

    settings: Config
    wrong: str
    """what is wrong with the config file, if anything"""
    terminal: int | None
    """the file that is one"""


class Finding(NamedTuple):
    """What a check came to."""

    good: bool | None
    """None: it may hinder some, and is worth knowing"""
    words: str
