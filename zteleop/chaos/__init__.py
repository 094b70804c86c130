"""What goes wrong, put into a robot on purpose. One file per kind of fault, one line below."""

from collections.abc import Iterator
from importlib import import_module

from zteleop.chaos.fault import Fault

KINDS = {
    "processes": "a process dies, freezes, or fails inside",
    "people": "several people, or one who does the wrong thing",
    "link": "the link is cut, slow, or comes back",
    "strangers": "what anybody on an open network can do",
    "load": "floods, and a busy machine",
    "chip": "the chip does not answer, forgets, or is somebody else's",
}


def faults() -> Iterator[tuple[str, Fault]]:
    """Yield every fault and its kind."""
    for kind in KINDS:
        for fault in import_module(f"zteleop.chaos.{kind}").FAULTS:
            yield kind, fault
