"""One end of one way to say TwistStamped. `publish_to_handler.py` starts a pair of each.

python peers.py NAME publish|subscribe ENDPOINT: a publisher says as many as each line of stdin asks for,
100 a second; a subscriber prints how many microseconds after its making each message reached its handler.
"""

import os
import socket
import struct
import sys
import threading
import time

PERIOD = 0.01
SIZE = 173
"""Bytes of zteleop's TwistStamped as JSON."""


def now() -> float:
    return time.clock_gettime(time.CLOCK_BOOTTIME)


def parts(at: float) -> tuple[int, int]:
    """Return a time as a stamp's seconds and nanoseconds."""
    return int(at), int(at % 1 * 1e9)


def report(sent: float) -> None:
    os.write(1, f"{(now() - sent) * 1e6:.1f}\n".encode())


def say(publish) -> None:
    """Publish what stdin asks for."""
    os.write(1, b"ready\n")
    for line in sys.stdin:
        due = time.monotonic()
        for _ in range(int(line)):
            due += PERIOD
            time.sleep(max(0.0, due - time.monotonic()))
            publish()


def zteleop(role: str, endpoint: str) -> None:
    from zteleop import BusSettings, Node, TwistStamped
    from zteleop.messages import Header, Time, Twist

    where = {"listen": [endpoint]} if role == "publish" else {"connect": [endpoint]}
    with Node("bench", "bench", BusSettings(multicast=False, **where)) as node:
        if role == "publish":
            publisher = node.publisher("motion", TwistStamped)
            twist = Twist.planar(0.123456, 0.654321)
            say(lambda: publisher.publish(TwistStamped(Header(Time(*parts(now())), "base_link"), twist)))

        def handle(received) -> None:
            stamp = received.message.header.stamp
            report(stamp.sec + stamp.nanosec / 1e9)

        node.subscription("motion", TwistStamped, handle)
        node.spin()


def raw(role: str, endpoint: str, handed: bool = False) -> None:
    """Raw zenoh with zteleop's settings; the main thread blocks in `recv`, or is woken as by a Pump."""
    from raw_line import open_session, zenoh

    side = "listen" if role == "publish" else "connect"
    with open_session(**{f"{side}/endpoints": [endpoint]}) as session:
        if role == "publish":
            drop = zenoh.CongestionControl.DROP
            publisher = session.declare_publisher("robot/bench/motion", congestion_control=drop)
            say(lambda: publisher.put(struct.pack("d", now()) + bytes(SIZE - 8)))
        ring = session.declare_subscriber("robot/bench/motion", zenoh.handlers.RingChannel(10))
        receive = hand_over(ring.recv) if handed else ring.recv
        while True:
            report(struct.unpack_from("d", receive().payload.to_bytes())[0])


def raw_handed(role: str, endpoint: str) -> None:
    raw(role, endpoint, handed=True)


def hand_over(receive):
    """Return a `receive` whose waiting is done by a thread that rings the main thread's bell."""
    ear, bell = socket.socketpair()
    box = []

    def wait() -> None:
        while True:
            box.append(receive())
            bell.send(b"!")

    threading.Thread(target=wait, daemon=True).start()
    return lambda: (ear.recv(1), box.pop(0))[1]


def zeromq(role: str, endpoint: str) -> None:
    import zmq

    peer = zmq.Context().socket(zmq.PUB if role == "publish" else zmq.SUB)
    if role == "publish":
        peer.bind(endpoint.replace("tcp/", "tcp://"))
        say(lambda: peer.send(struct.pack("d", now()) + bytes(SIZE - 8)))
    peer.connect(endpoint.replace("tcp/", "tcp://"))
    peer.subscribe(b"")
    while True:
        report(struct.unpack_from("d", peer.recv())[0])


def rospy(role: str, endpoint: str) -> None:
    """Says TwistStamped through a master that listens at the endpoint."""
    port = endpoint.rpartition(":")[2]
    os.environ |= {"ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1"}
    import rospy
    from geometry_msgs.msg import TwistStamped

    if role == "publish":
        import rosmaster.master

        rosmaster.master.Master(int(port)).start()
    rospy.init_node(role, disable_signals=True)
    if role == "publish":
        publisher = rospy.Publisher("motion", TwistStamped, queue_size=10, tcp_nodelay=True)
        message = TwistStamped()
        message.header.frame_id = "base_link"

        def publish() -> None:
            message.header.stamp = rospy.Time(*parts(now()))
            publisher.publish(message)

        say(publish)
    rospy.Subscriber("motion", TwistStamped, lambda m: report(m.header.stamp.to_sec()), tcp_nodelay=True)
    rospy.spin()


if __name__ == "__main__":
    globals()[sys.argv[1]](*sys.argv[2:])
