import socket
import sys
from contextlib import suppress

import pytest

from zteleop.machine.unsent import unsent

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="Linux alone says it")


def test_what_nobody_takes_waits_and_is_counted() -> None:
    with (
        socket.create_server(("127.0.0.1", 0)) as listener,
        socket.create_connection(listener.getsockname()) as near,
        listener.accept()[0] as far,
    ):
        before = unsent()
        near.setblocking(False)
        with suppress(BlockingIOError):
            while True:
                near.send(bytes(2**16))
        assert unsent() > before + 2**16
        near.shutdown(socket.SHUT_WR)
        while far.recv(2**16):
            pass
        assert unsent() <= before
