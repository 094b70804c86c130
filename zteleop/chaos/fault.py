"""What can happen to a robot that drives, and what must follow."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Literal, NamedTuple

if TYPE_CHECKING:
    from zteleop.chaos.bench import Bench

Act = Callable[["Bench"], object]
Operator = Literal["here", "far", "program", "keyboard"]


class Fault(NamedTuple):
    """Something that is done to a robot which somebody drives."""

    name: str
    strike: Act
    """Returns when it struck, by the monotonic clock, where it took its time; or in words what went wrong."""
    bound: float | None = 0.05
    """s until its wheels are at rest; None where it may drive on"""
    then: Literal["rests", "drives", "either"] = "rests"
    """What follows while its operator goes on: `rests` for good, or `drives`, at the latest after a pause.

    `either` is an interruption: how long it takes on this machine decides.
    """
    operator: Operator = "here"
    """Who drives: this process (far: behind a link), a program of its own, or keys in a terminal."""
    before: Act = lambda _: None
    """Done before somebody drives."""
    afterwards: Act = lambda _: None
    """Done once its wheels are at rest."""
    simulated: bool = False
    """Only a simulated chip can be given it."""
