"""A loop that waits, and a signal: with the system's own clock and wait."""

import os
import signal
import threading

from zteleop.bus import clock
from zteleop.bus.loop import Loop


def test_a_signal_ends_the_wait_even_if_nothing_else_is_to_do() -> None:
    """Else one that comes between Python's last look and the system's wait is heard a minute later."""
    loop, heard = Loop(lambda: None), list[int]()
    before = signal.signal(signal.SIGUSR1, lambda number, frame: heard.append(number))
    woken: list[int] = []
    waits = loop.run_once

    def run_once(until: float | None = None) -> None:
        waits(until)
        woken.extend(heard)
        loop.stop()

    loop.run_once = run_once  # type: ignore[method-assign]
    sender = threading.Timer(0.05, lambda: os.kill(os.getpid(), signal.SIGUSR1))
    sender.start()
    began = clock.now()
    try:
        loop.run(clock.now() + 20.0)
    finally:
        signal.signal(signal.SIGUSR1, before)
        sender.join()
    assert woken == [signal.SIGUSR1]
    assert clock.now() - began < 15.0, "it waited as long as it was let"
    assert signal.set_wakeup_fd(-1) == -1, "whose it was is told again"
    loop.call_soon(loop.stop)
    loop.run()
    loop.close()
