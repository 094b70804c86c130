"""Why a text is no TOML: in the parser's words, and of what people often write in plain ones."""

import re
from typing import NamedTuple

UNCLOSED = ("Illegal character '\\n'", 'Expected "\'"', "Unterminated string")
"""what the parser says of a quote that nothing closes"""
BOOLEANS = ("true", "false", "yes", "no", "on", "off")
CURLY = "\u201c\u201d\u201e\u2018\u2019"
"""which text programs make of quotes"""


class NotToml(NamedTuple):
    """Where a parser stopped, as line or line:column, empty where it does not say; and why."""

    place: str
    words: str


def explained(error: str, text: str) -> NotToml:
    """Return what a parser's error means for a text."""
    words, _, where = error.partition(" (at ")
    lines = text.splitlines()
    at = re.match(r"line (\d+), column (\d+)", where)
    number = int(at[1]) if at else len(lines)
    written = lines[number - 1] if 0 < number <= len(lines) else ""
    place = f"{at[1]}:{at[2]}" if at else f"{number}" * bool(where)
    name, _, value = map(str.strip, written.partition("="))
    if twice := re.match(r"Cannot declare \((.*?),?\) twice", words):
        table = twice[1].replace(", ", ".").replace("'", "")
        return NotToml(place, f"[{table}] is written twice")
    if words == "Cannot overwrite a value":
        return NotToml(place, f"{name or 'a name'} is written twice")
    if words in UNCLOSED:
        return NotToml(place, "a text ends with the quote that it begins with, found none")
    if odd := next((quote for quote in CURLY if quote in written), ""):
        return NotToml(place, f"a text stands in \" or ', found {odd}")
    if value.lower() in BOOLEANS:
        return NotToml(place, f"yes and no are true and false, in small letters, found {value}")
    if words == "Invalid value":
        return NotToml(place, f"{words} (text needs quotes)" if value else "nothing stands behind =")
    if re.match(r"[-+]?\d+,\d", value):
        return NotToml(place, "a decimal point is a point, found a comma")
    return NotToml(place, words)
