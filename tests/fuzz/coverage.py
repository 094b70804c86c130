"""Search for bytes that break a target, guided by what they make the code do.

Run it in `tests` as `python -m fuzz.coverage TARGET --seconds 60`; for atheris, `pip install -e '.[fuzz]'`.
What does something new is kept in the user's cache, to begin with the next time; what breaks a target is
written there too, and belongs into `fuzz/corpus` once it is as short as can be.
"""

import argparse
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

FOUND = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "zteleop" / "fuzz"
LONGEST = 4096
"""bytes of one attempt"""
INSTRUMENTED = ["zteleop", "tomllib", "yaml"]


def main() -> None:
    """Fuzz one target for some seconds; exits with 77 where it breaks."""
    parser = argparse.ArgumentParser(
        prog="python -m fuzz.coverage", description=(__doc__ or "").partition("\n")[0]
    )
    parser.add_argument("target", nargs="?", help="what is attacked; --list names them")
    parser.add_argument("--list", action="store_true", help="name the targets, a line each")
    parser.add_argument("--seconds", type=int, default=60, help="default: 60")
    parser.add_argument("--found", type=Path, default=FOUND, help="where what is new is kept")
    options = parser.parse_args()
    try:
        import atheris
    except ImportError:
        sys.exit("expected atheris, found none; say: pip install -e '.[fuzz]' (Linux, Python 3.11 to 3.13)")
    with atheris.instrument_imports(include=INSTRUMENTED):
        from fuzz.reading import CORPUS
        from fuzz.targets import TARGETS
    if options.list:
        print("\n".join(TARGETS))  # noqa: T201
        return
    if options.target not in TARGETS:
        parser.error(f"expected one of {', '.join(TARGETS)}; found {options.target}")
    kept = options.found / options.target
    kept.mkdir(parents=True, exist_ok=True)
    flags = [f"-max_total_time={options.seconds}", f"-max_len={LONGEST}", "-rss_limit_mb=1024"]
    broken = f"-artifact_prefix={kept.parent}/{options.target}-"
    with scratch():
        child = os.fork()  # libFuzzer ends its process without any clean-up
        if not child:
            folders = [str(kept), str(CORPUS / options.target)]
            atheris.Setup([sys.argv[0], *flags, broken, *folders], TARGETS[options.target])
            atheris.Fuzz()
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    sys.exit(code)


@contextmanager
def scratch() -> Iterator[None]:
    """Let all that a target writes go to a folder, in memory where that can be, which is removed."""
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(prefix="zteleop-fuzz-", dir=memory) as folder:
        tempfile.tempdir = os.environ["XDG_STATE_HOME"] = folder
        yield


if __name__ == "__main__":
    main()
