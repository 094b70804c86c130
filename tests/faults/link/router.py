"""A zenoh router between both machines: python -m faults.link.router ENDPOINT."""

import signal
import sys

from zteleop.bus.settings import BusSettings
from zteleop.bus.zenoh_open import open_zenoh

if __name__ == "__main__":
    with open_zenoh(BusSettings(mode="router", listen=[sys.argv[1]], multicast=False)):
        sys.stdout.write("ready\n")
        sys.stdout.flush()
        signal.pause()
