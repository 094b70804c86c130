"""No real wheel turns before somebody has typed that it hangs in the air."""

import sys

from zteleop.errors import ConfigError

CONSENT = "wheels up"


def ask_consent(words: str) -> None:
    """Say what is about to happen, and wait for the answer; raises ConfigError for any other."""
    print(
        f"{words}\nLift them off the ground and hold nothing near them. Type {CONSENT!r} to go on: ",
        end="",
        file=sys.stderr,
        flush=True,
    )
    if sys.stdin.readline().strip() != CONSENT:
        raise ConfigError(f"nothing was done: expected the words {CONSENT!r}")
