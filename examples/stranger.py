"""A node of somebody else's, which knows zenoh, JSON and a key, and nothing of zteleop."""

import json

import zenoh

ROBOT, PLACE = "archangel", "tcp/127.0.0.1:7447"  # on another machine tcp/pi.local:7447

config = zenoh.Config()
config.insert_json5("connect/endpoints", json.dumps([PLACE]))
with zenoh.open(config) as session:
    statuses = session.declare_subscriber(f"robot/{ROBOT}/drive_status")
    for sample in statuses:
        status = json.loads(sample.payload.to_bytes())
        print(f"{sample.key_expr}: {status['state']}, {status['why']}", flush=True)
