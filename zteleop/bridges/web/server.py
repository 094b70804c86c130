"""Serves the page, and keeps one connection to each that is open; all of it in one thread of its own."""

import asyncio
import contextlib
import ssl
from collections.abc import Callable
from functools import partial
from http import HTTPStatus
from itertools import count
from typing import Protocol

from websockets.asyncio.server import Server as Listening
from websockets.asyncio.server import ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response
from websockets.typing import Subprotocol

from zteleop.bridges.web.files import HEADERS, INDEX, File, load
from zteleop.bridges.web.slots import Slots
from zteleop.bridges.web.tickets import PROTOCOL, Tickets
from zteleop.bridges.web.words import LONGEST, Note, Said, read, text
from zteleop.errors import MessageError

PLACE = "/bus"
"""the path of the connection; every other one is a file"""
MOST_PAGES = 40
MOST_MISTAKES = 20
"""of one page, after which it is no page of ours"""
PING_EVERY, PONG_WITHIN, OPENED_WITHIN = 1.0, 2.0, 5.0
"""s"""
NOTHING_READ = 2**18
"""bytes on their way to a page, after which newer frames take the place of older ones"""


class Cockpit(Protocol):
    """What is behind the server; called in the server's thread."""

    def join(self, page: str, slots: Slots) -> None:
        """Let a page in; what it is to be told goes into its slots."""

    def leave(self, page: str) -> None:
        """Forget a page."""

    def hear(self, page: str, said: Said) -> None:
        """Take in what a page says."""


class Server:
    """Lets pages in that have a ticket; `tell` hears of those that have none."""

    def __init__(
        self, tickets: Tickets, cockpit: Cockpit, tell: Callable[[str], object], index: str = INDEX
    ) -> None:
        self._tickets = tickets
        self._cockpit = cockpit
        self._tell = tell
        self._files = load(index)
        self._numbers = count(1)
        self._pages: set[str] = set()

    async def open(self, host: str | None, port: int, security: ssl.SSLContext | None = None) -> Listening:
        """Return the server, listening; raises OSError where somebody else does."""
        return await serve(
            self._attend,
            host,
            port,
            ssl=security,
            process_request=self._answer,
            subprotocols=[Subprotocol(PROTOCOL)],
            compression=None,
            server_header=None,
            max_size=LONGEST,
            max_queue=4,
            write_limit=NOTHING_READ,
            open_timeout=OPENED_WITHIN,
            ping_interval=PING_EVERY,
            ping_timeout=PONG_WITHIN,
        )

    def _answer(self, connection: ServerConnection, request: Request) -> Response | None:
        """Return a file, or a refusal in words; None for a page that may connect."""
        host = request.headers.get("Host", "")
        if wrong := self._tickets.unknown_host(host):
            return self._refuse(connection, wrong)
        path = request.path.partition("?")[0]
        if path != PLACE:
            return respond(self._files.get(path))
        offered = ", ".join(request.headers.get_all("Sec-WebSocket-Protocol"))
        protocols = [one.strip() for one in offered.split(",")]
        if wrong := self._tickets.refusal(host, request.headers.get("Origin"), protocols):
            return self._refuse(connection, wrong)
        if len(self._pages) >= MOST_PAGES:
            return self._refuse(connection, f"{MOST_PAGES} pages are open already: close one")
        return None

    def _refuse(self, connection: ServerConnection, words: str) -> Response:
        address = connection.remote_address
        self._tell(f"{address[0] if address else 'somebody'} is refused: {words}")
        return respond(File("text/plain; charset=utf-8", f"{words}\n".encode()), HTTPStatus.FORBIDDEN)

    async def _attend(self, connection: ServerConnection) -> None:
        page, event = f"page {next(self._numbers)}", asyncio.Event()
        slots = Slots(partial(asyncio.get_running_loop().call_soon_threadsafe, event.set))
        self._pages.add(page)
        self._cockpit.join(page, slots)
        says = asyncio.create_task(pass_on(connection, slots, event))
        try:
            await self._listen(connection, page, slots)
        except ConnectionClosed:
            pass
        finally:
            self._pages.discard(page)
            self._cockpit.leave(page)
            says.cancel()
            with contextlib.suppress(asyncio.CancelledError, ConnectionClosed):
                await says

    async def _listen(self, connection: ServerConnection, page: str, slots: Slots) -> None:
        mistakes = 0
        async for frame in connection:
            try:
                said = read(frame)
            except MessageError as error:
                mistakes += 1
                slots.put("mistake", text(Note(str(error), alarm=True)))
                if mistakes > MOST_MISTAKES:
                    await connection.close(1008, "no page of this server")
                continue
            self._cockpit.hear(page, said)


async def pass_on(connection: ServerConnection, slots: Slots, event: asyncio.Event) -> None:
    """Send what waits for a page, one frame after another, as fast as it takes them."""
    while True:
        await event.wait()
        event.clear()
        while (frame := slots.take()) is not None:
            await connection.send(frame)


def respond(file: File | None, status: HTTPStatus = HTTPStatus.OK) -> Response:
    """Return an answer with the headers that everything has."""
    if file is None:
        return respond(File("text/plain; charset=utf-8", b"there is no such page\n"), HTTPStatus.NOT_FOUND)
    headers = Headers(HEADERS | {"Content-Type": file.type, "Content-Length": str(len(file.body))})
    return Response(status.value, status.phrase, headers, file.body)
