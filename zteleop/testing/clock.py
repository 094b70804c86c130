"""Time that passes when a test says so."""


class Clock:
    """Seconds, as the bus clock counts them."""

    def __init__(self, time: float = 1000.0) -> None:
        self.time = time

    def now(self) -> float:
        return self.time

    def pass_by(self, seconds: float) -> None:
        """Let so many seconds pass; nothing happens meanwhile."""
        self.time += seconds
