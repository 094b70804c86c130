"""A link that is closed holds up nobody, however silent its other end is."""

import os
import socket
import stat
import sys
from collections.abc import Iterator
from contextlib import suppress

import pytest
from rig import free_port, until

from zteleop.bus.settings import BusSettings
from zteleop.bus.zenoh_open import open_zenoh


def lingering(port: int) -> Iterator[bool]:
    """Yield for each end of a link at that port whether it lingers."""
    for name in os.listdir("/dev/fd"):
        with suppress(OSError):
            if stat.S_ISSOCK(os.stat(int(name)).st_mode):
                with socket.socket(fileno=os.dup(int(name))) as end:
                    if port in (end.getsockname()[1], end.getpeername()[1]):
                        yield end.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER) != 0


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no /dev/fd; sockets there do not linger")
def test_no_link_lingers_on_either_side() -> None:
    port = free_port()
    endpoint = f"tcp/127.0.0.1:{port}"
    with open_zenoh(BusSettings(listen=[endpoint], multicast=False)):
        for _ in range(2):  # one that was there, and one that comes anew
            with open_zenoh(BusSettings(connect=[endpoint], multicast=False)):
                until(lambda: list(lingering(port)) == [False, False], "two ends that do not linger")
