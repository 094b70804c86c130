import argparse
import json
import select
from collections import deque
from collections.abc import Iterable

from zteleop import config
from zteleop.bus import clock
from zteleop.cli import _options
from zteleop.cli._driving import KILLED
from zteleop.inputs.keymap import KEYMAPS, OTHER, bindings
from zteleop.machine.guardian import guarded
from zteleop.terminal.keys import Key
from zteleop.terminal.typed import Typed, open_terminal

EXAMPLES = (
    "zteleop keys",
    "zteleop keys --keymap twist",
)
LOOK_EVERY = 0.05
"""s between two looks, in which a lone Escape is told from the start of a sequence"""
KEPT = 200
"""of what was pressed"""
END = "ctrl-c"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add_config(parser)
    parser.add_argument("--keymap", choices=[*KEYMAPS], help="what the keys would do by another map")


def run(arguments: argparse.Namespace) -> None:
    settings = config.load(arguments.config)
    bound = bindings(settings.keys, arguments.keymap or settings.keymap)
    terminal = open_terminal()
    seen = Seen(bound)
    with guarded(terminal.name, terminal.farewell + KILLED), terminal:
        typed = Typed(terminal)
        while not (typed.ended or seen.enough):
            seen.take(typed.read(clock.now()))
            terminal.draw(seen.page(typed.releases.told, *terminal.size()))
            select.select([terminal], [], [], LOOK_EVERY)
    for line in seen.advice():
        print(line)


class Seen:
    """What was pressed at a terminal, and what each key is bound to."""

    def __init__(self, bound: dict[str, str]) -> None:
        self.enough = False
        """Ctrl-C was pressed."""
        self._bound = bound
        self._rows: deque[str] = deque(maxlen=KEPT)
        self._free: dict[str, None] = {}
        """the keys that do nothing, in the order they were pressed"""

    def take(self, keys: Iterable[Key]) -> None:
        for key in keys:
            does = self._bound.get(key.name) or self._bound.get(key.name.lower())
            words = does or self._bound.get(OTHER, "bound to nothing")
            self._rows.append(f"{key.name:<14}{key.event:<10}{words}")
            if not does and len(self._free) < KEPT:
                self._free[key.name] = None
            self.enough = self.enough or key.name == END

    def page(self, told: bool, columns: int, rows: int) -> list[str]:
        """Return the lines of a screen: what the terminal can, and what was pressed last."""
        knows = "tells when a key is let go" if told else "does not tell when a key is let go: docs/keys.md"
        head = [f"This terminal {knows}.", "Press keys; Ctrl-C ends.", "", f"{'key':<14}{'event':<10}does"]
        newest = list(self._rows)[-max(rows - len(head), 1) :]
        return [line[:columns] for line in (*head, *newest)][:rows]

    def advice(self) -> list[str]:
        """Return what to write into config.toml so that a key that does nothing does something."""
        if not self._free:
            return []
        key = next(iter(self._free))
        bare = key.replace("-", "").isalnum() and key.isascii()
        name = key if bare else json.dumps(key, ensure_ascii=False)
        return ["Bind keys in config.toml, such as:", "", "[keys]", f'{name} = "stop robot"']
