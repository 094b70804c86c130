"""What somebody says once is not lost because its link is full for a moment."""

import os
import signal
import sys
import threading
from pathlib import Path

import pytest
from rig import Process, free_port

from zteleop.bus.session import open_session
from zteleop.bus.settings import BusSettings

LARGE = bytes(5_000_000)
"""more than the buffers of a link hold"""
COUNT, STANDS_FOR = 3, 0.2
LISTENER = """
import json, sys, zenoh
config = zenoh.Config()
config.insert_json5("listen/endpoints", json.dumps([sys.argv[1]]))
config.insert_json5("scouting/multicast/enabled", "false")
with zenoh.open(config) as session:
    with session.declare_subscriber("robot/ghost/photo", zenoh.handlers.FifoChannel(10)) as photos:
        print("listens", flush=True)
        for number, photo in enumerate(photos, 1):
            print(f"photo {number}: {len(photo.payload)}", flush=True)
"""


@pytest.fixture
def endpoint() -> str:
    return f"tcp/127.0.0.1:{free_port()}"


def test_what_is_said_patiently_waits_while_its_listener_stands_still(endpoint: str, tmp_path: Path) -> None:
    listener = Process([sys.executable, "-c", LISTENER, endpoint], os.environ, tmp_path)
    try:
        listener.says("listens")
        settings = BusSettings(mode="client", connect=[endpoint], multicast=False)
        with open_session(settings, patient=True) as session:
            photos = session.advertise("robot/ghost/photo", urgent=False)
            listener.signal(signal.SIGSTOP)
            threading.Timer(STANDS_FOR, lambda: listener.signal(signal.SIGCONT)).start()
            for _ in range(COUNT):
                photos.put(LARGE, "", None)
            listener.says(f"photo {COUNT}: {len(LARGE)}")
    finally:
        listener.close()
