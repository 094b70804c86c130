"""A lane for stops that needs no zenoh: datagrams that engage, never release, and are answered.

    {"zteleop": "stop", "robot": "archangel", "id": 7, "by": "ann@desk", "why": "somebody is under it"}
    {"zteleop": "answer", "robot": "archangel", "id": 7, "held": true, "confirmed": "read"}

Whoever stops a robot says the first again and again; the robot answers each with the second, `confirmed`
as in `drive_status`. A robot that listens on tcp/[::]:7447 hears stops on 7447/udp. Where robots find each
other by multicast they share a group as well, so that several on one machine hear it; the one that has the
port passes on what is meant for another.
"""
