import socket
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any, Self

import pytest
import zenoh

from zteleop.bus import linger


class End:
    """A socket with two ports, which notes what is set."""

    def __init__(self, here: int, there: int | None) -> None:
        self._here, self._there = here, there
        self.options: list[tuple[int, int, bytes]] = []
        self.closed = False

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc: object) -> None:
        self.closed = True

    def getsockname(self) -> tuple[str, int]:
        return "10.0.0.1", self._here

    def getpeername(self) -> tuple[str, int]:
        if self._there is None:
            raise OSError("it listens")
        return "10.0.0.2", self._there

    def setsockopt(self, *option: Any) -> None:
        self.options.append(option)


def event(kind: Any, here: str, there: str, streamed: bool = True) -> Any:
    return SimpleNamespace(kind=kind, link=SimpleNamespace(src=here, dst=there, is_streamed=streamed))


PUT, DELETE = zenoh.SampleKind.PUT, zenoh.SampleKind.DELETE
LINK = ("tcp/10.0.0.1:7447", "tcp/10.0.0.2:40000")


@pytest.fixture
def ends(monkeypatch: pytest.MonkeyPatch) -> list[End]:
    """A listener, another link, and the link that is meant."""
    ends = [End(7447, None), End(7447, 40001), End(7447, 40000)]

    def sockets() -> Iterator[End]:
        yield from ends

    monkeypatch.setattr(linger, "_sockets", sockets)
    return ends


def test_a_new_link_is_told_not_to_linger_and_no_other_socket(ends: list[End]) -> None:
    linger._notice(event(PUT, *LINK))
    assert [end.options for end in ends] == [[], [], [(socket.SOL_SOCKET, socket.SO_LINGER, bytes(8))]]
    assert all(end.closed for end in ends)


@pytest.mark.parametrize(
    "other",
    [
        event(DELETE, *LINK),
        event(PUT, *LINK, streamed=False),
        event(PUT, "unixsock-stream//run/bus", "unixsock-stream/7447"),
    ],
)
def test_nothing_is_done_about_anything_else(ends: list[End], other: Any) -> None:
    linger._notice(other)
    assert not any(end.options for end in ends)


@pytest.mark.parametrize(
    ("locator", "port"),
    [
        ("tcp/127.0.0.1:7447", 7447),
        ("tls/[fe80::1%eth0]:7448?rel=1#so_sndbuf=16384", 7448),
        ("unixsock-stream//tmp/bus", None),
        ("unixsock-stream/faca143f-9402", None),
    ],
)
def test_the_port_of_a_locator(locator: str, port: int | None) -> None:
    assert linger._port(locator) == port
