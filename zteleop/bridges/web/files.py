"""What a browser loads: the files of one folder, and nothing else of this machine."""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

FOLDER = Path(__file__).with_name("static")
TYPES = {
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
    ".webmanifest": "application/manifest+json",
}
INDEX = "index.html"
HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
        "manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-cache",
}
"""of everything that is served: no other page frames this one, and it loads nothing from elsewhere"""


class File(NamedTuple):
    type: str
    body: bytes


def load(index: str = INDEX, folder: Path = FOLDER) -> Mapping[str, File]:
    """Return every file that may be asked for, by its path; what is in no list is not there."""
    found = {
        f"/{path.relative_to(folder).as_posix()}": File(TYPES[path.suffix], path.read_bytes())
        for path in sorted(folder.rglob("*"))
        if path.suffix in TYPES
    }
    return found | {"/": found[f"/{index}"]}
