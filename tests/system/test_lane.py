"""A stop that needs no zenoh: from a shell and by hand, to the chip, whatever befell the bus."""

import json
import re
import socket
import subprocess
import sys
import time

import pytest
from rig import NEUTRAL, PATIENCE, ROOT, Rig, free_port, until

BY_HAND = b'{"zteleop": "stop", "robot": "bench", "id": 7, "by": "a button"}'
PAGE = ROOT / "docs/upstream/zenoh-poisoned-lock.md"


def say(rig: Rig, text: bytes) -> dict[str, object]:
    """Say a datagram until it is answered with the chip's word; return the answer."""
    answer: dict[str, object] = {}
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as mouth:
        mouth.settimeout(0.05)
        give_up = time.monotonic() + PATIENCE
        while not answer.get("confirmed") and time.monotonic() < give_up:
            mouth.sendto(text, ("127.0.0.1", rig.port))
            try:
                answer = json.loads(mouth.recv(2000))
            except TimeoutError:
                continue
    return answer


def test_zenoh_is_still_poisoned_by_what_is_no_key_expression() -> None:
    (program,) = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
    ports = {"17447": str(free_port()), "17448": str(free_port())}
    for ours, free in ports.items():
        program = program.replace(ours, free)
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=PATIENCE)
    assert run.stdout == "deaf\n", f"this zenoh is mended: say so on {PAGE}\n{run.stderr}"


@pytest.mark.usefixtures("driving")
def test_a_few_bytes_by_hand_stop_it_and_it_says_that_it_stands(rig: Rig) -> None:
    answer = say(rig, BY_HAND)
    assert (answer["robot"], answer["id"], answer["held"], answer["confirmed"]) == ("bench", 7, True, "read")
    assert rig.ticks == NEUTRAL
    until(lambda: "a button" in rig.result("why", *rig.bus_options()).stdout, "who stopped it")


def test_a_datagram_never_releases(rig: Rig) -> None:
    rig.actuator()
    stop = {"zteleop": "stop", "robot": "bench", "id": 7, "by": "ann@desk"}
    assert say(rig, json.dumps(stop).encode())["held"]
    for said in (stop | {"engaged": False}, stop | {"zteleop": "release"}, stop | {"id": 0}):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as mouth:
            mouth.sendto(json.dumps(said).encode(), ("127.0.0.1", rig.port))
    assert say(rig, json.dumps(stop).encode())["held"], "it is in force"
    release = rig.result("stop", "--release", "--all", *rig.bus_options())
    assert release.returncode == 0, release.stderr
    # The actuator says that it is released; the watchdog, which answers here, may hear of it a moment later.
    until(lambda: say_once(rig, json.dumps(stop).encode())["held"] is False, "the release at the watchdog")
    assert say_once(rig, json.dumps(stop).encode())["held"] is False, "what is released stays released"


def say_once(rig: Rig, text: bytes) -> dict[str, object]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as mouth:
        mouth.settimeout(PATIENCE)
        mouth.sendto(text, ("127.0.0.1", rig.port))
        return dict(json.loads(mouth.recv(2000)))


@pytest.mark.usefixtures("driving")
def test_garbage_by_the_thousand_neither_stops_it_nor_keeps_a_stop_out(rig: Rig) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as mouth:
        for number in range(3000):
            mouth.sendto(b"garbage %d" % number, ("127.0.0.1", rig.port))
            if number % 100 == 0:
                time.sleep(0.02)
        assert rig.ticks != NEUTRAL
    assert say(rig, BY_HAND)["confirmed"] == "read"


def test_a_robot_that_is_told_not_to_hears_none(rig: Rig) -> None:
    rig.set("bus.stop_lane = false")
    rig.actuator()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as mouth:
        mouth.settimeout(0.5)
        mouth.connect(("127.0.0.1", rig.port))
        mouth.send(BY_HAND)
        with pytest.raises(ConnectionRefusedError):
            mouth.recv(2000)
