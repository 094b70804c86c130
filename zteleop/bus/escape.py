"""What strangers say, made harmless to a terminal."""


def printable(text: str, keep: str = "") -> str:
    """Escape every character that could steer a terminal or hide text, as JSON escapes it."""
    return "".join(c if c.isprintable() or c in keep else _escape(c) for c in text)


def _escape(character: str) -> str:
    units = character.encode("utf-16-be", "surrogatepass")
    return "".join(f"\\u{units[i]:02x}{units[i + 1]:02x}" for i in range(0, len(units), 2))
