"""What a process that must not be late asks of Linux; each wish is granted or said, never fatal."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

PRIORITY = "real-time priority"
LOCKED = "locked memory"
SURVIVAL = "low OOM score"

FEEDERS = 5
"""Priority of the threads that bring a loop what it must not be late for: below every such loop."""

MCL_CURRENT, MCL_FUTURE, MCL_ONFAULT = 1, 2, 4  # <asm-generic/mman.h>: Arm and x86


class Linux:
    """The calls themselves; each raises OSError when it is refused."""

    oom_score = Path("/proc/self/oom_score_adj")

    def run_first(self, priority: int) -> None:
        """Let this thread, and none that it starts, run before all ordinary ones."""
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(priority))

    def rank(self) -> tuple[int, int]:
        """Return how this thread is scheduled: policy and priority."""
        return os.sched_getscheduler(0), os.sched_getparam(0).sched_priority

    def run_as(self, policy: int, priority: int) -> None:
        """Schedule this thread, and those that it starts, so."""
        os.sched_setscheduler(0, policy, os.sched_param(priority))

    def lock_memory(self) -> None:
        """Keep every page once it is touched; pages that never are cost nothing.

        Under a finite limit MCL_FUTURE makes some later allocation fail, and that kills. So the limit
        goes, or becomes 0: then the kernel grants only those whom no limit binds.
        """
        import resource  # Unix alone has it

        before = resource.getrlimit(resource.RLIMIT_MEMLOCK)
        try:
            resource.setrlimit(resource.RLIMIT_MEMLOCK, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        except ValueError:  # Python's word for EPERM
            resource.setrlimit(resource.RLIMIT_MEMLOCK, (0, before[1]))
        try:
            _mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT)
        except OSError:
            resource.setrlimit(resource.RLIMIT_MEMLOCK, before)
            raise


def ask_for(priority: int, oom_score: int, system: Linux | None = None) -> list[str]:
    """Ask for SCHED_FIFO for this thread, memory that stays, and a low OOM score; return what was refused."""
    if system is None and sys.platform != "linux":
        return [PRIORITY, LOCKED, SURVIVAL]
    kernel = system or Linux()
    wishes: dict[str, Callable[[], None]] = {
        PRIORITY: lambda: kernel.run_first(priority),
        LOCKED: kernel.lock_memory,
        SURVIVAL: lambda: _survive(kernel.oom_score, oom_score),
    }
    return [phrase for phrase, wish in wishes.items() if not _granted(wish)]


def try_out(priority: int, oom_score: int) -> list[str]:
    """Return what `ask_for` would be refused; a process of its own asks, and this one stays as it is."""
    program = f"from {__name__} import ask_for; print(*ask_for({priority}, {oom_score}), sep='\\n')"
    told = subprocess.check_output([sys.executable, "-c", program], text=True)
    return [wish for wish in told.splitlines() if wish]


@contextmanager
def lent(priority: int, system: Linux | None = None) -> Iterator[None]:
    """Start threads that run before all ordinary ones, for a loop that will `take` that priority.

    Zenoh starts its own, and each inherits from who starts it. Were they ordinary, every command would wait
    for one of them behind whatever else is busy, however urgent the loop it is for: a priority inversion.
    Who may not run first lends nothing, lest the loop come after what feeds it.
    """
    if system is None and sys.platform != "linux":
        yield
        return
    kernel = system or Linux()
    before = kernel.rank()
    _granted(lambda: _lend(kernel, priority))
    try:
        yield
    finally:  # a process started later must not inherit it
        _granted(lambda: kernel.run_as(*before))


def follow() -> None:
    """Let this thread keep up with a main thread that runs first; the interpreter is theirs in turn."""
    if _main_runs_first():
        _granted(lambda: Linux().run_first(1))


def _lend(kernel: Linux, priority: int) -> None:
    kernel.run_as(os.SCHED_RR, priority)
    kernel.run_as(os.SCHED_RR, FEEDERS)


def _main_runs_first() -> bool:
    if sys.platform != "linux":
        return False
    return os.sched_getscheduler(os.getpid()) & ~os.SCHED_RESET_ON_FORK == os.SCHED_FIFO


def _granted(wish: Callable[[], None]) -> bool:
    try:
        wish()
    except OSError:
        return False
    return True


def _mlockall(flags: int) -> None:
    import ctypes  # 2 ms, and only a robot needs it

    if ctypes.CDLL(None, use_errno=True).mlockall(flags):
        raise OSError(ctypes.get_errno(), "mlockall")


def _survive(file: Path, score: int) -> None:
    try:
        chosen = int(file.read_text())
        if chosen < 0:  # systemd's OOMScoreAdjust, or a parent's; anybody may go above it
            score = max(score, chosen)
        file.write_text(str(score))
    except ValueError as error:
        raise OSError(f"{file}: {error}") from None
