"""Pages by way of a server: a real robot, a real bus, and connections as a browser makes them."""

import asyncio
import json
import re
import signal
import socket
import ssl
import subprocess
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest
from processes import Process
from rig import NEUTRAL, Rig, until
from websockets.asyncio import client as aio
from websockets.exceptions import ConnectionClosed, InvalidMessage, InvalidStatus
from websockets.sync.client import ClientConnection, connect

THROTTLE = 1
SERVER = """
import sys
from zteleop import BusSettings, Node
from zteleop.bridges.web.cockpit import Cockpit
from zteleop.bridges.web.server import Server
from zteleop.bridges.web.serving import serving
from zteleop.bridges.web.tickets import Tickets, new_token
from zteleop.control.report import to_vehicle
from zteleop.control.settings import DriveSettings
token = new_token()
with Node("web", "bench", BusSettings(connect=[sys.argv[1]], multicast=False)) as node:
    cockpit = Cockpit(node, to_vehicle(DriveSettings(), 4.08), "1.0")
    server = Server(Tickets(token), cockpit, node.log.warn)
    with serving(server, "127.0.0.1", 0) as port:
        print(f"open http://127.0.0.1:{port}/#t={token}", flush=True)
        cockpit.run()
"""


class Page:
    """Does as a page of ours: it gives the newest beat back, and says 50 times a second what is held."""

    def __init__(self, connection: ClientConnection) -> None:
        self.connection = connection
        self.words: list[dict[str, Any]] = []
        self.drive: float | None = None
        self.closed = False
        self._beat = {"epoch": 0, "time": 0.0}
        self._threads = [threading.Thread(target=run) for run in (self._hear, self._say)]
        self.say({"is": "watch", "topics": ["beat", "drive_status"]})
        for thread in self._threads:
            thread.start()
        until(lambda: self._beat["epoch"], "a beat")

    def say(self, word: dict[str, Any]) -> None:
        self.connection.send(json.dumps(word))

    def told(self, kind: str) -> list[dict[str, Any]]:
        return [word for word in self.words if word["is"] == kind]

    def close(self) -> None:
        self.closed = True
        self.connection.close()
        for thread in self._threads:
            thread.join()

    def _hear(self) -> None:
        with suppress(ConnectionClosed):
            for frame in self.connection:
                word = json.loads(frame)
                if word["is"] == "heard" and word["topic"] == "beat":
                    self._beat = word["message"]
                else:
                    self.words.append(word)

    def _say(self) -> None:
        seq = 0
        while not self.closed:
            if (drive := self.drive) is not None:
                seq += 1
                beat = {"epoch": self._beat["epoch"], "beat": self._beat["time"]}
                self.say(
                    {"is": "held", "seq": seq, "drive": drive, "turn": 0, "deadman": bool(drive), **beat}
                )
            time.sleep(0.02)


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("web")) as bench:
        bench.actuator()
        yield bench


@pytest.fixture(scope="module")
def server(rig: Rig) -> Process:
    process = rig.program(SERVER, rig.endpoint)
    process.says("open http://127.0.0.1:")
    return process


@contextmanager
def page(server: Process, token: str | None = None, origin: str | None = None) -> Iterator[Page]:
    found = re.search(r"http://(\S+)/#t=(\S+)", server.text)
    assert found
    place, right = found.groups()
    protocols: Any = ["zteleop.v1", f"token.{token or right}"]
    with connect(
        f"ws://{place}/bus", subprotocols=protocols, origin=origin or f"http://{place}"
    ) as connection:  # type: ignore[arg-type]
        opened = Page(connection)
        try:
            yield opened
        finally:
            opened.close()


def test_a_page_drives_while_it_holds_something_and_rests_when_it_lets_go(rig: Rig, server: Process) -> None:
    with page(server) as ann:
        ann.drive = 0.5
        until(lambda: (rig.ticks[THROTTLE] or 0) > NEUTRAL[THROTTLE], "it drives")
        until(lambda: any(seen["obeyed"] for seen in ann.told("seen")), "and is told so")
        ann.drive = 0.0
        until(lambda: rig.ticks == tuple(NEUTRAL), "it rests")


def test_a_page_that_falls_silent_is_neutral(rig: Rig, server: Process) -> None:
    with page(server) as ann:
        ann.drive = 0.5
        until(lambda: (rig.ticks[THROTTLE] or 0) > NEUTRAL[THROTTLE], "it drives")
        ann.drive = None
        until(lambda: rig.ticks == tuple(NEUTRAL), "it rests")


def test_a_page_that_is_gone_is_neutral(rig: Rig, server: Process) -> None:
    with page(server) as ann:
        ann.drive = 0.5
        until(lambda: (rig.ticks[THROTTLE] or 0) > NEUTRAL[THROTTLE], "it drives")
    until(lambda: rig.ticks == tuple(NEUTRAL), "it rests")


def test_a_second_page_drives_nothing_but_stops_everything(rig: Rig, server: Process) -> None:
    with page(server) as ann, page(server) as bob:
        ann.drive = 0.5
        until(lambda: (rig.ticks[THROTTLE] or 0) > NEUTRAL[THROTTLE], "it drives")
        bob.drive = -0.5
        bob.say({"is": "wish", "of": "take"})
        until(lambda: bob.told("note"), "an answer")
        assert "drives: it must let go, or hand over" in bob.told("note")[0]["says"]
        assert (rig.ticks[THROTTLE] or 0) > NEUTRAL[THROTTLE]
        bob.say({"is": "wish", "of": "stop"})
        until(lambda: rig.ticks == tuple(NEUTRAL), "it rests")
        until(lambda: any("stopped" in seen["note"] for seen in bob.told("seen")), "confirmed by the chip")
        ann.drive = bob.drive = 0.0
        bob.say({"is": "wish", "of": "release"})
        until(lambda: any("may drive again" in seen["note"] for seen in bob.told("seen")), "released")


@pytest.mark.parametrize(
    "wrong", [{"token": "x"}, {"origin": "http://evil.example"}], ids=["token", "origin"]
)
def test_strangers_are_refused_and_told_of(server: Process, wrong: dict[str, str]) -> None:
    with pytest.raises(InvalidStatus) as refused, page(server, **wrong):
        pass
    assert refused.value.response.status_code == 403
    assert refused.value.response.body
    words = refused.value.response.body.decode().strip()
    until(lambda: words in server.text.replace("\n", " "), f"the server says: {words}")


def test_nonsense_is_answered_and_too_much_of_it_ends_the_connection(server: Process) -> None:
    with page(server) as ann:
        ann.connection.send("{")
        until(lambda: ann.told("note"), "an answer")
        assert ann.told("note")[0]["says"].startswith("expected what a page of this server says")
        with suppress(ConnectionClosed):
            for _ in range(30):
                ann.connection.send("{")
        until(lambda: ann.connection.close_code, "the end")
        assert ann.connection.close_code == 1008
        ann.closed = True


def test_two_hundred_who_connect_and_say_nothing_keep_nobody_from_driving(rig: Rig, server: Process) -> None:
    found = re.search(r"http://(\S+):(\d+)/#t=", server.text)
    assert found
    with ExitStack() as stack:
        for _ in range(200):
            stack.enter_context(socket.create_connection((found[1], int(found[2]))))
        with page(server) as ann:
            ann.drive = 0.5
            until(lambda: (rig.ticks[THROTTLE] or 0) > NEUTRAL[THROTTLE], "it drives")
            ann.drive = 0.0
            until(lambda: rig.ticks == tuple(NEUTRAL), "it rests")
    assert server.text.count("\n") < 50, "what strangers do does not fill the log"


def test_a_frame_that_is_too_long_ends_its_connection_and_no_other(rig: Rig, server: Process) -> None:
    with page(server) as ann, page(server) as bob:
        ann.drive = 0.5
        until(lambda: (rig.ticks[THROTTLE] or 0) > NEUTRAL[THROTTLE], "it drives")
        with suppress(ConnectionClosed):
            bob.connection.send("x" * 70_000)
        until(lambda: bob.connection.close_code, "the end")
        assert bob.connection.close_code == 1009
        bob.closed = True
        assert (rig.ticks[THROTTLE] or 0) > NEUTRAL[THROTTLE], "ann drives on"
        ann.drive = 0.0
        until(lambda: rig.ticks == tuple(NEUTRAL), "it rests")


@pytest.fixture
def pair(tmp_path: Path) -> tuple[str, str]:
    certificate, key = str(tmp_path / "car.pem"), str(tmp_path / "car.key")
    about = "req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 -subj /CN=car"
    alias = ["-addext", "subjectAltName=IP:127.0.0.1"]
    command = ["openssl", *about.split(), *alias, "-keyout", key, "-out", certificate]
    subprocess.run(command, check=True, capture_output=True)
    return certificate, key


def test_a_page_is_served_in_every_network_and_by_tls(rig: Rig, pair: tuple[str, str]) -> None:
    certificate, key = pair
    where = ("--port", "0", "--serve-at", "0.0.0.0")
    server = rig.join("web", *where, "--tls-cert", certificate, "--tls-key", key)
    server.says("open https://")
    found = re.search(r"https://(\S+):(\d+)/#t=(\S+)", server.text)
    assert found
    own, port, token = found.groups()
    trust = ssl.create_default_context(cafile=certificate)
    trust.check_hostname = False  # its own address is whatever network this machine is in
    protocols: Any = ["zteleop.v1", f"token.{token}"]

    async def greeted(place: str) -> str:
        """Open a page, in one thread: a TLS connection must not be written and read at once."""
        about: Any = {"subprotocols": protocols, "origin": f"https://{place}"}
        async with aio.connect(f"wss://{place}/bus", ssl=trust, **about) as page:
            return str(json.loads(await page.recv())["is"])

    for host in {"127.0.0.1", own}:
        assert asyncio.run(greeted(f"{host}:{port}")) == "hello"
    with pytest.raises(InvalidMessage), connect(f"ws://127.0.0.1:{port}/bus", subprotocols=protocols):
        pass
    assert "read the address along" not in server.text
    server.signal(signal.SIGINT)
    server.ends()


def test_a_page_that_anybody_can_read_along_says_so(rig: Rig) -> None:
    server = rig.join("web", "--port", "0", "--serve-at", "0.0.0.0")
    server.says("whoever shares this network can read the address along; --tls-cert keeps it secret")
    server.signal(signal.SIGINT)
    server.ends()


def test_what_is_no_certificate_is_told_before_anything_is_served(rig: Rig, tmp_path: Path) -> None:
    server = rig.join("web", "--port", "0", "--tls-cert", str(tmp_path / "none.pem"))
    assert server.ends() == 1
    assert "expected" in server.text
    assert "No such file or directory; docs/phone.md makes a pair" in server.text.replace("\n", " ")
    assert "open http" not in server.text
