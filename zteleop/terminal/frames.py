"""From lines to the bytes that show them, of which as few as possible."""

from collections.abc import Sequence

BEGIN, END = "\x1b[?2026h", "\x1b[?2026l"
"""DEC's synchronised output: nothing is shown until the frame is whole."""
CLEAR = "\x1b[2J"


def changes(lines: Sequence[str], shown: Sequence[str] | None) -> str:
    """Return what turns the lines shown into these; None shown is a screen of unknown content."""
    before = shown or ()
    rows = [
        # erase first: after a full row the cursor hangs on its last cell, which erasing would take
        f"\x1b[{row + 1};1H\x1b[2K{line}"
        for row, line in enumerate([*lines, *[""] * (len(before) - len(lines))])
        if row >= len(before) or line != before[row]
    ]
    clear = CLEAR if shown is None else ""
    return f"{BEGIN}{clear}{''.join(rows)}{END}" if rows or clear else ""


def one_line(lines: Sequence[str], columns: int) -> str:
    """Return the first line for a terminal that knows no more than to go back to its beginning."""
    return f"\r{''.join(lines[:1]).ljust(columns - 1)[: columns - 1]}"
