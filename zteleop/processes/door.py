"""The door of a robot: alone it speaks zenoh, with strangers and for the robot's own processes."""

import os
import signal
import socket
import sys
from contextlib import closing, suppress
from typing import NoReturn

import msgspec

from zteleop.bus import clock
from zteleop.bus.door.host import Host
from zteleop.bus.loop import Loop
from zteleop.bus.settings import BusSettings
from zteleop.bus.zenoh_open import open_zenoh
from zteleop.bus.zenoh_session import ZenohSession
from zteleop.errors import ConfigError, DeviceError
from zteleop.machine import limits, realtime, signals, stderr
from zteleop.machine.door import ALIVE, ALIVE_EVERY
from zteleop.machine.newcomer import LOOK_EVERY, Newcomer, own_listeners
from zteleop.processes import PROGRAMS

PROGRAM = PROGRAMS["door"]
PROVE_EVERY = 0.3
"""s; 50 us of work each. A multiple of what wakes this process anyway"""
FILES = 1024
"""that may be open, which is as many as `select` takes: zenoh's own limits lie below it"""
BROKEN = 70
"""EX_SOFTWARE of sysexits.h"""


class Orders(msgspec.Struct, frozen=True):
    """What a watchdog says on its door's standard input."""

    bus: BusSettings
    settle: bool
    """first wait until everybody is found"""


def run(listener: int, link: int) -> int:
    """Open the door at a socket that listens, with the orders on stdin, until its watchdog leaves."""
    for number in signals.ENDING:  # last of all, when nobody says anything any more
        signal.signal(number, signal.SIG_IGN)
    orders = _orders(sys.stdin.buffer.read())
    place, watchdog = _adopt(listener), _adopt(link)
    watchdog.setblocking(False)
    limits.allow_files(FILES)
    with realtime.lent(PROGRAM.priority):
        session = ZenohSession(open_zenoh(orders.bus, settle=orders.settle, door=True))
    with place, watchdog, session, closing(Newcomer(own_listeners())) as newcomer:
        realtime.ask_for(PROGRAM.priority, PROGRAM.oom_score)
        loop = Loop(lambda: None)
        Host(session, place, loop, stderr.tell)
        loop.watch(watchdog.fileno(), loop.stop)  # it says nothing, so this is its end
        loop.every(ALIVE_EVERY, lambda: _say_alive(watchdog))
        loop.every(PROVE_EVERY, session.prove)
        loop.every(LOOK_EVERY, lambda: _must_let_in(newcomer))
        try:
            loop.run()
        except Exception:
            raise
        except BaseException as error:  # zenoh's panic is no Exception, and what it broke cannot be closed
            _end_broken(f"zenoh broke ({str(error) or type(error).__name__})")
    stderr.flush()
    return 0


def _must_let_in(newcomer: Newcomer) -> None:
    if not newcomer.is_let_in(clock.now()):
        _end_broken("it takes nobody in who connects")


def _end_broken(why: str) -> NoReturn:
    stderr.tell(f"door: error: {why}; this door ends")
    stderr.flush()
    os._exit(BROKEN)


def _say_alive(watchdog: socket.socket) -> None:
    with suppress(OSError):  # full: it is frozen
        watchdog.send(ALIVE)


def _orders(text: bytes) -> Orders:
    try:
        return msgspec.json.decode(text, type=Orders)
    except (msgspec.MsgspecError, ValueError, RecursionError) as error:
        raise ConfigError(
            f"expected a watchdog's orders on standard input: {error}; zteleop actuator starts its door"
        ) from None


def _adopt(number: int) -> socket.socket:
    try:
        return socket.socket(fileno=number)
    except (OSError, ValueError, OverflowError):
        raise DeviceError(f"file {number} is no watchdog's; zteleop actuator starts its door") from None
