"""What a terminal is able to show, by the environment."""

from collections.abc import Mapping


def wants_color(environ: Mapping[str, str]) -> bool:
    """Return whether colours are welcome (no-color.org)."""
    return not environ.get("NO_COLOR") and environ.get("TERM", "dumb") not in ("", "dumb")


def speaks_unicode(environ: Mapping[str, str], encoding: str | None) -> bool:
    """Return whether the locale says UTF-8; without a locale, standard output's encoding decides."""
    names = ["LC_ALL", "LC_CTYPE", "LANG"]
    if environ.get("LANG") in ("C", "POSIX") and environ.get("LC_CTYPE") == "C.UTF-8":
        names.remove("LC_CTYPE")  # Python itself put it there (PEP 538)
    locale = next((environ[name] for name in names if environ.get(name)), encoding)
    return "utf8" in (locale or "").lower().replace("-", "") and environ.get("TERM") != "linux"
