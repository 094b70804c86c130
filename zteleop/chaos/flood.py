"""Says the same very often, on topics in turn.

`python -m zteleop.chaos.flood ENDPOINT ROBOT RATE BYTES TOPIC...`
"""

import json
import os
import sys
import time
from itertools import cycle

from zteleop.bus.node import Node
from zteleop.bus.settings import BusSettings
from zteleop.messages import Twist

IN_A_ROW = 20
"""messages at once, where the rate allows no better"""
TWIST = {"linear": {"x": 1.0, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.0}}
ENCODING = f"application/json;{Twist.ros_type}"


def main(endpoint: str, robot: str, rate: str, size: str, *topics: str) -> None:
    """Say valid twists of a length, without a proof, until the process is ended."""
    bus = BusSettings(mode="client", connect=[endpoint], multicast=False)
    in_a_row = IN_A_ROW if float(rate) > 1000 else 1
    payload = json.dumps(TWIST).encode().ljust(int(size))
    with Node("flood", robot, bus) as node:
        session = node.membership.session
        outlets = cycle([session.advertise(f"robot/{robot}/{topic}", False) for topic in topics])
        os.write(1, b"floods\n")
        due = time.monotonic()
        while True:
            for _ in range(in_a_row):
                next(outlets).put(payload, ENCODING, None)
            due += in_a_row / float(rate)
            time.sleep(max(0.0, due - time.monotonic()))


if __name__ == "__main__":
    main(*sys.argv[1:])
