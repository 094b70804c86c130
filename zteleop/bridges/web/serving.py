"""The server's own thread: the node's loop stays where signals are, and neither waits for the other."""

import asyncio
import ssl
import threading
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager

from zteleop.bridges.web.server import Server
from zteleop.errors import BusError
from zteleop.machine import signals

OPENED_WITHIN = 5.0
"""s"""


@contextmanager
def serving(server: Server, host: str, port: int, security: ssl.SSLContext | None = None) -> Iterator[int]:
    """Serve pages for as long as a `with` lasts, and yield the port; raises BusError where that is taken."""
    opened: Future[int] = Future()
    loop, end = asyncio.new_event_loop(), asyncio.Event()

    async def serve() -> None:
        try:
            listening = await server.open(host, port, security)
        except OSError as error:
            opened.set_exception(error)
            return
        async with listening:
            opened.set_result(next(iter(listening.sockets)).getsockname()[1])
            await end.wait()

    thread = threading.Thread(target=loop.run_until_complete, args=(serve(),), name="web", daemon=True)
    signals.start(thread)
    try:
        yield _opened(opened, f"{host} port {port}")
    finally:
        loop.call_soon_threadsafe(end.set)
        thread.join(OPENED_WITHIN)
        if not thread.is_alive():
            loop.close()


def _opened(opened: "Future[int]", where: str) -> int:
    try:
        return opened.result(OPENED_WITHIN)
    except OSError as error:
        reason = error.strerror or str(error)
        raise BusError(f"cannot serve pages at {where}: {reason}; choose another --port") from None
