"""A newcomer's try at sockets that answer, hang up, or are stuck."""

import errno
import os
import socket
import struct
from collections.abc import Iterator

import pytest

from zteleop.machine.newcomer import EVERY, LOOK_EVERY, LOOKS, Listener, Newcomer, own_listeners


@pytest.fixture(params=[(socket.AF_INET, "127.0.0.1"), (socket.AF_INET6, "::"), (socket.AF_INET, "0.0.0.0")])
def server(request: pytest.FixtureRequest) -> Iterator[socket.socket]:
    family, host = request.param
    with socket.create_server((host, 0), family=family) as listener:
        yield listener


def listener_of(server: socket.socket) -> Listener:
    return Listener(server.family, server.getsockname())


def answers(newcomer: Newcomer, seconds: float, began: float = 0.0) -> list[bool]:
    """Ask for some seconds, none of which pass."""
    return [newcomer.is_let_in(began + LOOK_EVERY * n) for n in range(int(seconds / LOOK_EVERY))]


def test_a_listener_that_is_stuck_lets_nobody_in(server: socket.socket) -> None:
    newcomer = Newcomer([listener_of(server)])
    assert all(answers(newcomer, LOOK_EVERY * LOOKS))
    assert not newcomer.is_let_in(LOOK_EVERY * LOOKS)
    newcomer.close()


def test_one_whose_queue_is_full_may_be_under_attack_and_is_no_alarm(server: socket.socket) -> None:
    server.listen(0)
    with socket.create_connection(server.getsockname()[:2]):
        newcomer = Newcomer([listener_of(server)])
        assert all(answers(newcomer, 2 * EVERY))
        newcomer.close()


def test_to_be_hung_up_on_is_to_be_let_in_and_it_tries_again(server: socket.socket) -> None:
    newcomer = Newcomer([listener_of(server)])
    server.settimeout(10.0)
    for began in (0.0, EVERY):
        assert newcomer.is_let_in(began)
        end, _ = server.accept()
        end.close()
        assert all(answers(newcomer, EVERY, began))
    server.setblocking(False)
    with pytest.raises(BlockingIOError):
        server.accept()  # it came twice, and no more


def test_each_try_has_its_own_patience_and_a_reset_is_an_answer(server: socket.socket) -> None:
    newcomer = Newcomer([listener_of(server)])
    server.settimeout(10.0)
    for began in (0.0, EVERY):
        assert all(answers(newcomer, LOOK_EVERY * (LOOKS - 5), began))
        end, _ = server.accept()
        end.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        end.close()
        assert newcomer.is_let_in(began + LOOK_EVERY * LOOKS)


def test_what_it_says_is_no_greeting_and_a_word_is_an_answer(server: socket.socket) -> None:
    newcomer = Newcomer([listener_of(server)])
    server.settimeout(10.0)
    assert newcomer.is_let_in(0.0)
    end, _ = server.accept()
    with end:
        assert newcomer.is_let_in(0.1)
        assert end.recv(100).startswith(b"\x06\x00\xff")
        end.sendall(b"no")
        assert all(answers(newcomer, EVERY - 1.0, 0.2))


def test_each_listener_has_its_turn() -> None:
    with socket.create_server(("127.0.0.1", 0)) as one, socket.create_server(("127.0.0.1", 0)) as stuck:
        newcomer = Newcomer([listener_of(one), listener_of(stuck)])
        assert newcomer.is_let_in(0.0)
        one.accept()[0].close()
        assert all(answers(newcomer, EVERY))
        assert False in answers(newcomer, 3.0, EVERY)
        newcomer.close()


def test_where_nobody_listens_any_more_is_no_alarm() -> None:
    with socket.create_server(("127.0.0.1", 0)) as closed:
        listener = listener_of(closed)
    assert all(answers(Newcomer([listener]), 4 * EVERY))


def test_who_may_open_no_more_files_raises_no_alarm(
    server: socket.socket, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise OSError(errno.EMFILE, "Too many open files")

    listener = listener_of(server)
    monkeypatch.setattr(socket, "socket", refuse)
    assert all(answers(Newcomer([listener]), 2 * EVERY))


def test_who_listens_nowhere_is_asked_nothing() -> None:
    assert all(answers(Newcomer([]), 2 * EVERY))


def test_it_finds_what_this_process_listens_at(server: socket.socket) -> None:
    with (
        socket.create_connection(server.getsockname()[:2]),
        socket.socket(socket.AF_UNIX) as private,
        socket.socket(socket.AF_INET) as idle,
    ):
        idle.bind(("127.0.0.1", 0))
        private.bind("")
        private.listen()
        files = len(os.listdir("/dev/fd"))
        found = own_listeners()
        assert len(os.listdir("/dev/fd")) == files
        assert listener_of(server) in found
        assert all(family != socket.AF_UNIX for family, _ in found)
        assert idle.getsockname() not in [address for _, address in found]
    mine = listener_of(server)
    server.close()
    assert mine not in own_listeners()
