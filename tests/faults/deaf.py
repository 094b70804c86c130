"""Whether a stranger has made a robot deaf to newcomers."""

import time

import zenoh
from processes import PATIENCE

from zteleop.bus.settings import BusSettings
from zteleop.bus.zenoh_open import open_zenoh


def is_deaf(port: int) -> bool:
    """Say whether a newcomer's declarations are heard no more, which is what the poison does."""
    bus = BusSettings(mode="client", connect=[f"tcp/127.0.0.1:{port}"], multicast=False)
    with open_zenoh(bus) as session:
        inbox = session.declare_subscriber("robot/*/beat", zenoh.handlers.RingChannel(1))
        give_up = time.monotonic() + min(1.0, PATIENCE)
        while time.monotonic() < give_up:
            if inbox.try_recv() is not None:
                return False
            time.sleep(0.01)
    return True
