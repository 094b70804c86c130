"""A terminal at which a test types."""

from typing import Self


class FakeTerminal:
    """Reads what is put into `typed`; keeps what was asked of it."""

    def __init__(self) -> None:
        self.typed = b""
        self.gone = False
        """It hung up."""
        self.resumed = 0
        """How often the process was stopped and went on."""
        self.calls: list[str] = []
        self.said = ""
        """What it was asked for and told to change."""
        self.answers = False
        """It answers questions, so whoever asks may wait."""

    def read(self) -> bytes:
        if self.gone:
            raise EOFError
        typed = self.typed
        self.typed = b""
        return typed

    def fileno(self) -> int:
        return 7

    def say(self, text: str) -> bool:
        self.said += text
        return self.answers

    def switch_on(self, on: str, off: str) -> bool:
        if on in self.said:
            return False
        self.say(on)
        return True

    def redraw(self) -> None:
        self.calls.append("redraw")

    def suspend(self) -> None:
        self.calls.append("suspend")
        self.resumed += 1

    def __enter__(self) -> Self:
        self.calls.append("enter")
        return self

    def __exit__(self, *exc: object) -> None:
        self.calls.append("exit")
