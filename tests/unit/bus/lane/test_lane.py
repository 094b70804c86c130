"""Both ends of the lane, over real sockets of this machine."""

import socket
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing
from typing import Any

import pytest
from rig import free_port

from zteleop.bus.lane import ear as module
from zteleop.bus.lane import places
from zteleop.bus.lane.call import Call
from zteleop.bus.lane.ear import Ear, Heard
from zteleop.bus.lane.places import Place
from zteleop.bus.lane.wire import LONGEST, Answered, Asked, pack, unpack_answered
from zteleop.bus.settings import BusSettings
from zteleop.messages import Stop

STOP = Stop(True, 7, "ann@desk", "a cat")
PATIENCE = 10.0
NOW = 1000.0


def at(port: int, **others: Any) -> BusSettings:
    return BusSettings(listen=[f"tcp/127.0.0.1:{port}"], multicast=False, **others)


def towards(port: int, **others: Any) -> BusSettings:
    return BusSettings(connect=[f"tcp/127.0.0.1:{port}"], multicast=False, **others)


@pytest.fixture
def port() -> int:
    return free_port()


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    with ExitStack() as stack:
        yield stack


Listen = Callable[..., Ear]


@pytest.fixture
def listen(stack: ExitStack) -> Listen:
    def open_(robot: str, bus: BusSettings) -> Ear:
        return stack.enter_context(closing(Ear(robot, bus, pytest.fail)))

    return open_


def heard(ear: Ear, say: Callable[[], object], now: float = NOW) -> list[Heard]:
    """Say something until it is heard."""
    give_up = time.monotonic() + PATIENCE
    found: list[Heard] = []
    while not found and time.monotonic() < give_up:
        say()
        time.sleep(0.01)
        found = list(ear.take(now))
    return found


def answers(call: Call) -> list[Answered]:
    give_up = time.monotonic() + PATIENCE
    found: list[Answered] = []
    while not found and time.monotonic() < give_up:
        time.sleep(0.005)
        found = list(call.answers())
    return found


def test_a_stop_is_heard_and_answered(listen: Listen, stack: ExitStack, port: int) -> None:
    ear, call = listen("archangel", at(port)), stack.enter_context(Call(towards(port)))
    found = heard(ear, lambda: call.say("archangel", STOP))
    assert found[0].asked == Asked("archangel", 7, "ann@desk", "a cat")
    answer = Answered("archangel", 7, held=True, confirmed="read")
    found[0].answer(answer)
    assert answer in answers(call)


def test_a_name_is_found_while_nobody_waits_for_it(listen: Listen, stack: ExitStack, port: int) -> None:
    ear = listen("archangel", BusSettings(listen=[f"tcp/[::]:{port}"], multicast=False))
    call = stack.enter_context(Call(BusSettings(connect=[f"tcp/localhost:{port}"], multicast=False)))
    assert heard(ear, lambda: call.say("archangel", STOP))


def test_a_release_is_never_said(listen: Listen, stack: ExitStack, port: int) -> None:
    ear, call = listen("archangel", at(port)), stack.enter_context(Call(towards(port)))
    assert heard(ear, lambda: call.say("archangel", STOP))
    list(ear.take(NOW))
    call.say("archangel", Stop(False, 7, "ann@desk", ""))
    time.sleep(0.05)
    assert list(ear.take(NOW)) == []


def test_what_is_for_another_robot_is_not_heard(listen: Listen, stack: ExitStack, port: int) -> None:
    ear, call = listen("archangel", at(port)), stack.enter_context(Call(towards(port)))
    call.say("michael", STOP)
    assert [found.asked.robot for found in heard(ear, lambda: call.say("archangel", STOP))] == ["archangel"]


@pytest.mark.parametrize("off", ["ear", "call"])
def test_it_can_be_switched_off(listen: Listen, stack: ExitStack, port: int, off: str) -> None:
    ear = listen("archangel", at(port, stop_lane=off != "ear"))
    call = stack.enter_context(Call(towards(port, stop_lane=off != "call")))
    for _ in range(10):
        call.say("archangel", STOP)
        time.sleep(0.01)
        assert list(ear.take(NOW)) == []


def test_robots_that_share_a_machine_share_a_group(
    listen: Listen, stack: ExitStack, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(places, "GROUP_PORT", free_port())
    bus = BusSettings(listen=["tcp/127.0.0.1:0"])
    first, second = listen("archangel", bus), listen("michael", bus)
    call = stack.enter_context(Call(bus))
    list(first.take(NOW)), list(second.take(NOW))  # they join it now
    found = heard(second, lambda: call.say("michael", STOP))
    assert found[0].asked.robot == "michael"
    found[0].answer(Answered("michael", 7, held=True))
    assert answers(call)[0].robot == "michael"
    assert list(first.take(NOW)) == []


def test_who_has_the_port_passes_on_what_is_for_another_and_that_one_answers(
    listen: Listen, stack: ExitStack, monkeypatch: pytest.MonkeyPatch, port: int
) -> None:
    monkeypatch.setattr(places, "GROUP_PORT", free_port())
    bus = BusSettings(listen=[f"tcp/127.0.0.1:{port}"])
    first, second = listen("archangel", bus), listen("michael", bus)
    call = stack.enter_context(Call(towards(port)))

    def say() -> None:
        call.say("michael", STOP)
        time.sleep(0.005)
        assert list(first.take(NOW)) == []

    list(second.take(NOW))
    found = heard(second, say)
    found[0].answer(Answered("michael", 7, held=True))
    assert answers(call)[0].robot == "michael"


def test_a_port_that_another_robot_has_is_taken_when_that_one_is_gone(
    listen: Listen, stack: ExitStack, port: int
) -> None:
    first, second = Ear("archangel", at(port), pytest.fail), listen("michael", at(port))
    with closing(first):
        assert list(first.take(NOW)) == list(second.take(NOW)) == []
    call = stack.enter_context(Call(towards(port)))
    assert heard(second, lambda: call.say("michael", STOP), NOW + module.TEND_EVERY)


@pytest.mark.parametrize("host", ["192.0.2.1", "pi.local", "x" * 70])
def test_a_place_that_is_not_this_machines_is_told_once(port: int, host: str) -> None:
    told: list[str] = []
    bus = BusSettings(listen=[f"tcp/{host}:{port}"], multicast=False)
    with closing(Ear("archangel", bus, told.append)) as ear:
        for now in (NOW, NOW + 10.0):
            assert list(ear.take(now)) == []
    assert len(told) == 1
    assert told[0].startswith(f"hears no stops on {host}:{port}/udp: ")


def test_a_flood_of_one_sender_leaves_the_others_their_turn(listen: Listen, port: int) -> None:
    ear = listen("archangel", at(port))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as flood:
        for number in range(40):
            flood.sendto(pack(Asked("archangel", number + 1, "flood")), ("127.0.0.1", port))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.2", 0))
        other.sendto(pack(Asked("archangel", 99, "ann@desk")), ("127.0.0.1", port))
        found = [found.asked.id for found in ear.take(NOW)]
    assert found[-1] == 99
    assert len(found) <= 1 + module.OF_ONE


def test_new_stops_are_few_and_one_that_is_known_is_always_heard(listen: Listen, port: int) -> None:
    ear = listen("archangel", at(port))

    def say(number: int, now: float) -> list[int]:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as mouth:
            mouth.sendto(pack(Asked("archangel", number, "flood")), ("127.0.0.1", port))
        return [found.asked.id for found in ear.take(now)]

    at_once, every = module.STOPS_OF_ONE
    admitted = [number for number in range(1, 20) if say(number, NOW)]
    assert admitted == list(range(1, at_once + 1))
    assert say(1, NOW) == [1]
    assert say(30, NOW + every / 2) == []
    assert say(30, NOW + every) == [30]


def test_what_is_no_stop_costs_nothing_but_its_reading(listen: Listen, port: int) -> None:
    ear = listen("archangel", at(port))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as mouth:
        for said in (b"", b"garbage", bytes(LONGEST + 1), pack(Answered("archangel", 7, True))):
            mouth.sendto(said, ("127.0.0.1", port))
        mouth.sendto(pack(Asked("archangel", 9, "ann@desk")), ("127.0.0.1", port))
        assert [found.asked.id for found in ear.take(NOW)] == [9]


def test_nobody_can_have_an_answer_sent_to_a_third(listen: Listen, port: int) -> None:
    ear = listen("archangel", at(port))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as mouth:
        mouth.settimeout(PATIENCE)
        asked = Asked("archangel", 9, "ann@desk", "", ("192.0.2.1", 53))
        mouth.sendto(pack(asked), ("127.0.0.1", port))
        (found,) = ear.take(NOW)
        found.answer(Answered("archangel", 9, True))
        assert unpack_answered(mouth.recv(LONGEST)) == Answered("archangel", 9, True)


@pytest.mark.parametrize(
    ("endpoint", "place"),
    [
        ("tcp/pi.local:7447", Place("pi.local", 7447)),
        ("tcp/[::]:7447#exit_on_failure=false", Place("::", 7447)),
        ("tls/[fe80::1%eth0]:7447?x=1", Place("fe80::1%eth0", 7447)),
        ("udp/10.0.0.1:1", Place("10.0.0.1", 1)),
        ("tcp/[::]:0", None),
        ("unixsock-stream//tmp/bus", None),
    ],
)
def test_a_place_is_that_of_an_endpoint(endpoint: str, place: Place | None) -> None:
    assert places.places([endpoint]) == ([place] if place else [])
