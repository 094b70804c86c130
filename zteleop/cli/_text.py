"""A text file that somebody names."""

from pathlib import Path

from zteleop.errors import ConfigError

LONGEST = 2**20
"""bytes: /dev/zero has no end"""


def read_text(path: Path) -> str:
    """Return what a file says; raises ConfigError for what cannot be read, is too long, or no text."""
    try:
        with path.open("rb") as file:
            data = file.read(LONGEST + 1)
        if len(data) > LONGEST:
            raise ConfigError(f"{path}: expected at most {LONGEST} bytes, found more")
        return data.decode()
    except OSError as error:
        raise ConfigError(f"cannot read {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise ConfigError(f"{path}: expected a text in UTF-8") from None
