"""No real wheel turns before somebody has typed that it hangs in the air."""

import sys

from zteleop.errors import ConfigError

WHEELS_UP = ("Lift its wheels off the ground, and hold nothing near them.", "wheels up")
ROOM_AHEAD = ("Put it on the floor, with some metres of room, and stay beside it.", "room ahead")
"""what to do, and what is typed once that is done"""


def ask_consent(words: str, asked: tuple[str, str] = WHEELS_UP) -> None:
    """Say what is about to happen, and wait for the answer; raises ConfigError for any other."""
    do, consent = asked
    print(
        f"{words}\n{do} Type {consent!r} to go on: ",
        end="",
        file=sys.stderr,
        flush=True,
    )
    if sys.stdin.readline().strip() != consent:
        raise ConfigError(f"nothing was done: expected the words {consent!r}")
