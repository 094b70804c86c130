"""Limits of a machine that were reached, in one sentence: nobody's bug, and somebody can raise them."""

import errno

try:
    import resource  # now: when no more files may be open, it is too late
except ImportError:  # which is no Unix
    resource = None  # type: ignore[assignment]

_FULL = {
    errno.ENFILE: "this machine has as many files open as it may; end some programs, or raise fs.file-max",
    errno.ENOMEM: "this machine has no memory left; end some programs",
    errno.ENOSPC: "the disk is full; make room on it",
    errno.EDQUOT: "your share of the disk is full; make room on it",
}
_NO_THREAD = "can't start new thread"


def allow_files(number: int) -> None:
    """Let this process have so many files open, as far as its system lets it; macOS begins with 256."""
    if resource is None:
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = number if hard == resource.RLIM_INFINITY else min(number, hard)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))


def reached(error: BaseException) -> str:
    """Return which limit an error means and what to do; nothing where it is no limit."""
    if isinstance(error, MemoryError):
        return _FULL[errno.ENOMEM]
    if (isinstance(error, OSError) and error.errno == errno.EAGAIN) or _NO_THREAD in str(error):
        return f"no more than {_limit('RLIMIT_NPROC')} processes and threads may run here; raise ulimit -u"
    if not isinstance(error, OSError):
        return ""
    if error.errno == errno.EMFILE:
        files = _limit("RLIMIT_NOFILE")
        return f"no more than {files} files may be open here; raise ulimit -n, or LimitNOFILE of its unit"
    return _FULL.get(error.errno or 0, "")


def _limit(kind: str) -> str:
    if resource is None:
        return "these"
    soft, _ = resource.getrlimit(getattr(resource, kind))
    return "these" if soft == resource.RLIM_INFINITY else str(soft)
