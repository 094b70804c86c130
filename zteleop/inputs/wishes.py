"""What an operator asks besides driving: of the robot, by keys that repeat while held, and of the screen."""

from zteleop.inputs import Wish


class Wishes:
    """The newest that nobody has taken yet; a release never takes back a stop."""

    def __init__(self) -> None:
        self.newest: Wish | None = None
        self.help = False
        """Show what each key does."""
        self._asked = dict.fromkeys(Wish, float("-inf"))

    def ask(self, wish: Wish, gap: float, now: float) -> None:
        """Take in a press; one that follows the last within `gap` s is a key's repeat, and asks nothing."""
        if now - self._asked[wish] > gap and self.newest is not Wish.STOP:
            self.newest = wish
        self._asked[wish] = now
