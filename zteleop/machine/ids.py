"""Names that nobody else has."""

import secrets

BITS = 53
"""What every reader of JSON can count. Zero is nobody, and the greatest is many (`control.stop.MERGED`)."""


def new_id() -> int:
    """Return the id of a sender, a stop, or a start of a robot."""
    return 1 + secrets.randbelow(2**BITS - 3)
