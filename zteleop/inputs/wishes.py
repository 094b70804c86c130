"""What an operator asks besides driving: of the robot, by keys that repeat while held, and of the screen."""

from collections.abc import Iterable, Mapping

from zteleop.inputs import Wish

MISSED_FOR = 2.0
"""s that a key which does nothing is worth a word"""


class Wishes:
    """The newest that nobody has taken yet; a release never takes back a stop."""

    def __init__(self, switches: Iterable[str] = ()) -> None:
        self.newest: Wish | None = None
        self.help = False
        """Show what each key does."""
        self.switches = dict.fromkeys(switches, False)
        """Which are on."""
        self._asked: dict[Wish | str, float] = {}
        self._missed = ("", float("-inf"))

    def ask(self, wish: Wish, gap: float, now: float) -> None:
        """Take in a press; one that follows the last within `gap` s is a key's repeat, and asks nothing."""
        if self._is_new(wish, gap, now) and self.newest is not Wish.STOP:
            self.newest = wish

    def toggle(self, switch: str, gap: float, now: float) -> None:
        """Take in a press of a switch's key."""
        if self._is_new(switch, gap, now):
            self.switches[switch] = not self.switches[switch]

    def note(self, key: str, action: str, keys: Mapping[str, str], now: float) -> None:
        """Take in a press, and remember one of a key without an action; `keys` are those that have one."""
        says = {"stop robot": "stops the robot", "help": "shows what each key does"}
        does = ", ".join(f"{keys[name]} {what}" for name, what in says.items() if keys.get(name))
        more = f"; {does}" if does else ""
        self._missed = ("" if action else f"{key} does nothing here{more}", now)

    def missed(self, now: float) -> str:
        """Return what there is to say of a key that was just pressed, and does nothing."""
        words, at = self._missed
        return words if now - at < MISSED_FOR else ""

    def _is_new(self, what: Wish | str, gap: float, now: float) -> bool:
        before, self._asked[what] = self._asked.get(what, float("-inf")), now
        return now - before > gap
