"""Commands that tell by their pulses alone when they were sent, so that a chip shows how old they are.

Neighbouring moments differ in one channel by one tick, as in a Gray code.
"""

Ticks = tuple[int | None, int | None]
UNIT = 0.005
"""s between two codes"""
STEERING, THROTTLE = range(290, 460), range(380, 500)
PERIOD = UNIT * len(STEERING) * len(THROTTLE)
"""s after which codes come again"""


def encode(now: float) -> tuple[int, int]:
    """Return the ticks of steering and throttle of a command that is sent now."""
    high, low = divmod(int(now / UNIT) % (len(STEERING) * len(THROTTLE)), len(STEERING))
    return STEERING[-1 - low if high % 2 else low], THROTTLE[high]


def age(ticks: Ticks, now: float) -> float | None:
    """Return how long ago a command was sent, one unit too long at most; None for ticks that are no code."""
    steering, throttle = ticks
    if steering is None or throttle is None or steering not in STEERING or throttle not in THROTTLE:
        return None
    high, low = THROTTLE.index(throttle), STEERING.index(steering)
    if high % 2:
        low = len(STEERING) - 1 - low
    return (now - UNIT * (high * len(STEERING) + low)) % PERIOD
