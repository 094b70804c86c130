"""Sizes, times and numbers as a person reads them."""

from datetime import UTC, datetime, timedelta

SECOND = 10**9
"""ns"""


def size(number: int) -> str:
    """Return bytes as 812 bytes, 5.2 kB or 1.1 GB."""
    if number < 1000:
        return f"{number} bytes"
    value, unit = number / 1000, "kB"
    for larger in ("MB", "GB", "TB"):
        if value < 999.95:
            break
        value, unit = value / 1000, larger
    return f"{value:.1f} {unit}"


def span(ns: int) -> str:
    """Return a time as 2.304 s, 3 min 2.3 s or 2 h 3 min 5 s."""
    seconds = ns / SECOND
    if seconds < 60:
        return f"{seconds:.3f} s"
    minutes, rest = divmod(round(seconds, 1), 60)
    if minutes < 60:
        return f"{minutes:.0f} min {rest:.1f} s"
    hours, minutes = divmod(minutes, 60)
    return f"{hours:.0f} h {minutes:.0f} min {rest:.0f} s"


def moment(ns: int) -> str:
    """Return a time since 1970 as 2026-11-22 08:51:02.123 UTC."""
    when = datetime.fromtimestamp(0, UTC) + timedelta(microseconds=ns // 1000)
    return f"{when:%Y-%m-%d %H:%M:%S}.{ns % SECOND // 10**6:03} UTC"


def count(number: int, thing: str) -> str:
    """Return 1 message, or 2 messages."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"
