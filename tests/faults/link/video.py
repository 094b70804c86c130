"""A camera's pictures beside the commands, from sessions of their own: 1400 bytes each, 2 Mbit/s.

python -m faults.link.video send ENDPOINT | view ENDPOINT
"""

import sys
import time

import zenoh

from zteleop.bus.settings import BusSettings
from zteleop.bus.zenoh_open import open_zenoh

KEY = "robot/bench/camera/image/compressed"
PICTURE = bytes(1400)
PERIOD = 8 * len(PICTURE) / 2e6


def send(endpoint: str) -> None:
    with open_zenoh(BusSettings(listen=[endpoint], multicast=False)) as session:
        pictures = session.declare_publisher(KEY, congestion_control=zenoh.CongestionControl.DROP)
        due = time.monotonic()
        while True:
            pictures.put(PICTURE)
            due += PERIOD
            time.sleep(max(0.0, due - time.monotonic()))


def view(endpoint: str) -> None:
    """Say now and then how many pictures have come."""
    with open_zenoh(BusSettings(connect=[endpoint], multicast=False)) as session:
        pictures = session.declare_subscriber(KEY, zenoh.handlers.RingChannel(10))
        for number, _ in enumerate(pictures):
            if number % 50 == 0:
                sys.stdout.write(f"saw {number}\n")
                sys.stdout.flush()


if __name__ == "__main__":
    {"send": send, "view": view}[sys.argv[1]](sys.argv[2])
