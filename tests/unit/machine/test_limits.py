import errno
import resource

import pytest

from zteleop.machine import limits


def test_too_many_files_say_how_many_may_be_open_and_how_to_have_more() -> None:
    soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    said = limits.reached(OSError(errno.EMFILE, "Too many open files"))
    assert said == f"no more than {soft} files may be open here; raise ulimit -n, or LimitNOFILE of its unit"


@pytest.mark.parametrize(
    "error", [OSError(errno.EAGAIN, "try again"), RuntimeError("can't start new thread")]
)
def test_too_many_threads_say_so(error: Exception) -> None:
    said = limits.reached(error)
    assert said.startswith("no more than ")
    assert said.endswith(" processes and threads may run here; raise ulimit -u")


@pytest.mark.parametrize(
    ("error", "says"),
    [
        (MemoryError(), "no memory left"),
        (OSError(errno.ENOMEM, ""), "no memory left"),
        (OSError(errno.ENFILE, ""), "fs.file-max"),
        (OSError(errno.ENOSPC, ""), "make room"),
        (OSError(errno.EDQUOT, ""), "make room"),
    ],
)
def test_each_limit_says_what_to_do(error: Exception, says: str) -> None:
    assert says in limits.reached(error)


@pytest.mark.parametrize(
    "error", [OSError(errno.ENOENT, ""), OSError("odd"), ValueError(), RuntimeError("no")]
)
def test_what_is_no_limit_is_none(error: Exception) -> None:
    assert limits.reached(error) == ""


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ((256, resource.RLIM_INFINITY), (1024, resource.RLIM_INFINITY)),
        ((256, 512), (512, 512)),
        ((1024, 4096), (1024, 4096)),
        ((4096, 4096), (4096, 4096)),
        ((resource.RLIM_INFINITY, resource.RLIM_INFINITY), (resource.RLIM_INFINITY, resource.RLIM_INFINITY)),
    ],
)
def test_files_are_allowed_as_far_as_the_system_lets_it(
    monkeypatch: pytest.MonkeyPatch, before: tuple[int, int], after: tuple[int, int]
) -> None:
    set_to = [before]
    monkeypatch.setattr(resource, "getrlimit", lambda kind: before)
    monkeypatch.setattr(resource, "setrlimit", lambda kind, limit: set_to.append(limit))
    limits.allow_files(1024)
    assert set_to[-1] == after
