"""A door and those behind it, over real sockets; zenoh is a table of callbacks."""

import os
import socket
from collections.abc import Callable, Iterator
from itertools import product
from pathlib import Path
from typing import Any

import pytest

from zteleop.bus import clock
from zteleop.bus.door import host as module
from zteleop.bus.door.host import Host
from zteleop.bus.door.remote import Remote
from zteleop.bus.loop import Loop
from zteleop.bus.session import Question, Sample
from zteleop.errors import BusError


class Declared:
    def __init__(self, undo: Callable[[], object]) -> None:
        self.undeclare = undo


class Zenoh:
    """A bus that hands over in the thread that speaks."""

    def __init__(self) -> None:
        self.hearers: dict[str, list[Callable[[Sample], None]]] = {}
        self.takers: dict[str, Callable[[Question], object]] = {}
        self.alive: list[str] = []
        self.watchers: list[Callable[[Sample], None]] = []
        self.urgent: list[str] = []

    def hear(self, key: str, passes: Callable[[Sample], None]) -> Declared:
        if not key.startswith("robot/"):
            raise BusError(f"{key} is no key")
        self.hearers.setdefault(key, []).append(passes)
        return Declared(lambda: self.hearers[key].remove(passes))

    def hear_tokens(self, selector: str, passes: Callable[[Sample], None], history: bool) -> Declared:
        self.watchers.append(passes)
        for key in self.alive if history else ():
            passes(Sample(key, b"", ""))
        return Declared(lambda: self.watchers.remove(passes))

    def heed(self, key: str, take: Callable[[Question], object]) -> Declared:
        self.takers[key] = take
        return Declared(lambda: self.takers.pop(key))

    def advertise(self, key: str, urgent: bool) -> Any:
        outlet = Declared(lambda: None)
        outlet.put = lambda payload, encoding, attachment: self.say(  # type: ignore[attr-defined]
            Sample(key, payload, encoding, attachment)
        )
        self.urgent += [key] if urgent else []
        return outlet

    def stand(self, key: str) -> Declared:
        self.alive.append(key)
        self._tell(key, True)
        return Declared(lambda: self._fall(key))

    def tokens(self, selector: str) -> set[str]:
        return set(self.alive)

    def say(self, sample: Sample) -> None:
        for passes in list(self.hearers.get(sample.key, ())):
            passes(sample)

    def _fall(self, key: str) -> None:
        self.alive.remove(key)
        self._tell(key, False)

    def _tell(self, key: str, is_put: bool) -> None:
        for passes in list(self.watchers):
            passes(Sample(key, b"", "", None, is_put))


class House:
    """A door at a place, and those who knock there."""

    def __init__(self, place: str) -> None:
        self.place = place
        self.listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.listener.bind(place)
        self.listener.listen()
        self.complaints: list[str] = []
        self.guests: list[Remote] = []
        self.open()

    def open(self) -> None:
        self.loop = Loop(lambda: None)
        self.zenoh = Zenoh()
        self.host = Host(self.zenoh, self.listener, self.loop, self.complaints.append)  # type: ignore[arg-type]

    def guest(self) -> Remote:
        guest = Remote(self.place)
        self.guests.append(guest)
        self.settle(guest)
        return guest

    def settle(self, *guests: Remote) -> None:
        """Let everything that was said arrive."""
        for _ in range(5):
            self.loop.run(clock.now())
            for guest in guests:
                guest.read()

    def let_pass(self, seconds: float) -> None:
        """Let the door do what is due."""
        self.loop.run(clock.now() + seconds)

    def fall(self) -> None:
        """End as a process does."""
        for guest in self.host._guests:
            guest._wire.close()
        self.loop.close()


@pytest.fixture
def house(tmp_path: Path) -> Iterator[House]:
    house = House(str(tmp_path / "door"))
    yield house
    for guest in house.guests:
        guest.close()
    house.fall()
    house.listener.close()


def taken(ring: Any) -> list[Sample]:
    return list(iter(ring.try_recv, None))


def test_what_one_says_the_others_hear(house: House) -> None:
    one, other = house.guest(), house.guest()
    ring = other.subscribe("robot/a/beat", 10)
    outlet = one.advertise("robot/a/beat", urgent=True)
    house.settle(one, other)
    before = clock.now()
    outlet.put(b"1", "text/plain", b"proof")
    house.settle(one, other)
    (sample,) = taken(ring)
    assert sample[:-1] == Sample("robot/a/beat", b"1", "text/plain", b"proof", True)[:-1]
    assert before <= sample.at <= clock.now()
    assert outlet.matched
    assert house.zenoh.urgent == ["robot/a/beat"]


def test_a_stranger_is_heard_by_each_and_the_newest_are_kept(house: House) -> None:
    guests = [house.guest() for _ in range(3)]
    rings = [guest.subscribe("robot/a/pwm", depth) for guest, depth in zip(guests, (1, 2, 3), strict=True)]
    house.settle(*guests)
    for number in range(4):
        house.zenoh.say(Sample("robot/a/pwm", bytes([number]), ""))
    house.settle(*guests)
    assert [[sample.payload[0] for sample in taken(ring)] for ring in rings] == [[3], [2, 3], [1, 2, 3]]


def test_what_is_undeclared_is_heard_no_more(house: House) -> None:
    guest = house.guest()
    ring = guest.subscribe("robot/a/pwm", 1)
    house.settle(guest)
    ring.undeclare()
    house.settle(guest)
    assert house.zenoh.hearers == {"robot/a/pwm": []}


def test_who_leaves_takes_its_tokens_with_it_and_others_see_that(house: House) -> None:
    one, other = house.guest(), house.guest()
    one.declare_token("robot/a/live/node/actuator/pi-7")
    house.settle(one, other)
    come = other.watch_tokens("robot/a/live/**", 10, history=True)
    house.settle(one, other)
    one.close()
    house.settle(other)
    assert [(sample.key, sample.is_put) for sample in taken(come)] == [
        ("robot/a/live/node/actuator/pi-7", True),
        ("robot/a/live/node/actuator/pi-7", False),
    ]


def test_a_next_door_is_told_all_that_was_declared(house: House) -> None:
    one, other = house.guest(), house.guest()
    ring = other.subscribe("robot/a/beat", 10)
    outlet = one.advertise("robot/a/beat", urgent=False)
    one.declare_token("robot/a/live/node/actuator/pi-7")
    gone = one.subscribe("robot/a/pwm", 1)
    gone.undeclare()
    house.settle(one, other)
    house.fall()
    one.read()
    other.read()
    assert not one.is_open
    outlet.put(b"lost", "", None)
    house.open()
    house.settle(one, other)
    outlet.put(b"heard", "", None)
    house.settle(one, other)
    assert [sample.payload for sample in taken(ring)] == [b"heard"]
    assert house.zenoh.alive == ["robot/a/live/node/actuator/pi-7"]
    assert list(house.zenoh.hearers) == ["robot/a/beat"]


def test_what_is_declared_while_no_door_is_open_is_declared_to_the_next(house: House) -> None:
    house.fall()
    early = Remote(house.place)
    house.guests.append(early)
    ring = early.subscribe("robot/a/beat", 1)
    house.open()
    house.settle(early)
    house.zenoh.say(Sample("robot/a/beat", b"1", ""))
    house.settle(early)
    assert len(taken(ring)) == 1


def test_a_flood_costs_a_robot_so_much_and_no_more(house: House, monkeypatch: pytest.MonkeyPatch) -> None:
    guest, now = house.guest(), clock.now()
    ring = guest.subscribe("robot/a/pwm", 10_000)
    other = guest.subscribe("robot/a/stop", 1)
    house.settle(guest)
    for times in (1, 2):
        monkeypatch.setattr(module.clock, "now", lambda times=times: now + times)  # type: ignore[misc]
        for _ in range(2 * module.AT_ONCE):
            house.zenoh.say(Sample("robot/a/pwm", b"1", ""))
        house.zenoh.say(Sample("robot/a/stop", b"1", ""))
        heard = []
        while not (stops := taken(other)):
            house.host._flush()
            guest.read()
        heard += taken(ring)
        assert (len(heard), len(stops)) == (module.AT_ONCE, 1)


def test_a_flood_without_a_proof_takes_no_commands_place(
    house: House, monkeypatch: pytest.MonkeyPatch
) -> None:
    guest, now = house.guest(), clock.now()
    ring = guest.subscribe("robot/a/pwm", 10_000)
    house.settle(guest)
    monkeypatch.setattr(module.clock, "now", lambda: now)
    for _ in range(2 * module.AT_ONCE):
        house.zenoh.say(Sample("robot/a/pwm", b"bare", ""))
    house.zenoh.say(Sample("robot/a/pwm", b"command", "", b"proof"))
    heard = []
    while b"command" not in heard:
        house.host._flush()
        guest.read()
        heard += [sample.payload for sample in taken(ring)]
    assert len(heard) == module.AT_ONCE + 1


def test_a_command_waits_for_no_flood_on_any_key_but_for_what_is_in_the_socket(house: House) -> None:
    guest, keys = house.guest(), [f"robot/a/cmd_vel/{number}" for number in range(10)]
    rings = [guest.subscribe(key, 10_000) for key in keys]
    house.settle(guest)
    for _, key in product(range(module.AT_ONCE), keys):
        house.zenoh.say(Sample(key, b"bare", ""))
    house.zenoh.say(Sample(keys[0], b"command", "", b"proof"))
    guest.read()
    in_socket = sum(len(taken(ring)) for ring in rings)
    house.host._flush()
    guest.read()
    assert b"command" in [sample.payload for sample in taken(rings[0])]
    assert in_socket < module.AT_ONCE * len(keys) / 4, "or nothing has waited"


def test_who_reads_nothing_holds_up_nobody_and_hears_the_rest_later(house: House) -> None:
    frozen, other = house.guest(), house.guest()
    late, ring = frozen.subscribe("robot/a/odd", 10_000), other.subscribe("robot/a/odd", 10_000)
    house.loop.run(clock.now() + 0.01)
    large = 100
    for _ in range(large):
        house.zenoh.say(Sample("robot/a/odd", bytes(100_000), ""))
        other.read()
    house.settle(other)
    assert len(taken(ring)) == large
    for _ in range(large):
        frozen.read()
        house.let_pass(module.FLUSH_EVERY)
    kept = len(taken(late))
    assert module.WAITING / 100_000 <= kept < large


def test_the_rest_of_a_frame_follows_when_there_is_room(house: House) -> None:
    guest = house.guest()
    ring = guest.subscribe("robot/a/odd", 10)
    house.settle(guest)
    house.zenoh.say(Sample("robot/a/odd", bytes(1_500_000), ""))  # more than a socket takes at once
    for _ in range(20):
        guest.read()
        house.let_pass(module.FLUSH_EVERY)
    assert [len(sample.payload) for sample in taken(ring)] == [1_500_000]
    assert not house.host._flush_is_due, "and then it sleeps again"


def test_a_door_that_has_passed_everything_on_sleeps(house: House) -> None:
    house.guest()
    assert min(timer.due for timer in house.loop._timers) > clock.now() + module.UNANSWERED / 2


def test_a_question_that_nobody_answers_is_forgotten(house: House, monkeypatch: pytest.MonkeyPatch) -> None:
    guest = house.guest()
    guest.serve("robot/a/srv/x", lambda question: None)
    house.settle(guest)
    house.zenoh.takers["robot/a/srv/x"](Question(b"", "", print, print))
    (door,) = house.host._guests
    assert len(door._questions) == 1
    now = clock.now()
    monkeypatch.setattr(module.clock, "now", lambda: now + 2.1 * module.UNANSWERED)
    house.let_pass(0.0)
    assert not door._questions


def test_who_attends_is_told_at_once_and_then_of_all_that_came_within_a_while(
    house: House, monkeypatch: pytest.MonkeyPatch
) -> None:
    guest, told, within, passed = house.guest(), list[int](), 60.0, 0.0
    real = clock.now
    monkeypatch.setattr(clock, "now", lambda: real() + passed)
    loop = Loop(lambda: None)
    ring = guest.subscribe("robot/a/pwm", 10)
    house.settle(guest)
    guest.attend(lambda: told.append(len(taken(ring))), loop, within)

    def say(payload: bytes) -> None:
        house.zenoh.say(Sample("robot/a/pwm", payload, ""))
        loop.run(clock.now())

    for payload in (b"1", b"2", b"3"):
        say(payload)
    assert told == [1], "at once, and the rest waits"
    for _ in range(2):
        passed += within
        loop.run(clock.now())
    assert told == [1, 2]
    say(b"4")
    assert told == [1, 2, 1], "after a pause again at once"
    guest.close()
    loop.close()


def test_a_name_that_zenoh_does_not_take_is_said_and_ends_nobody(house: House) -> None:
    guest = house.guest()
    guest.subscribe("no key", 1)
    ring = guest.subscribe("robot/a/pwm", 1)
    house.settle(guest)
    assert house.complaints == ["the door cannot do what it is asked: no key is no key"]
    house.zenoh.say(Sample("robot/a/pwm", b"1", ""))
    house.settle(guest)
    assert len(taken(ring)) == 1


class Inbox:
    """An inbox whose samples are read as they came."""

    def __init__(self, ring: Any) -> None:
        self.ring = ring

    def read(self, sample: Sample) -> Sample:
        return sample


def test_a_handler_has_one_message_a_round_however_many_wait_for_another(house: House) -> None:
    guest, loop, heard = house.guest(), Loop(lambda: None), []
    for topic in ("pwm", "stop"):
        ring = guest.subscribe(f"robot/a/{topic}", 10)
        guest.deliver(Inbox(ring), lambda sample: heard.append(sample.key[8:]), loop)
    house.loop.run(clock.now() + 0.01)
    for key in 3 * ["robot/a/pwm"] + ["robot/a/stop"]:
        house.zenoh.say(Sample(key, b"1", ""))
    loop.run(clock.now() + 0.05)
    guest.close()
    loop.close()
    assert heard == ["pwm", "stop", "pwm", "pwm"]


def test_who_waits_for_a_message_has_it_and_a_closed_session_ends_the_wait(house: House) -> None:
    guest = house.guest()
    ring = guest.subscribe("robot/a/pwm", 10)
    house.settle(guest)
    house.zenoh.say(Sample("robot/a/pwm", b"1", ""))
    assert ring.recv().payload == b"1"
    guest.close()
    with pytest.raises(EOFError):
        ring.recv()


def test_who_finds_nobody_at_the_place_knocks_again(house: House) -> None:
    guest, loop = house.guest(), Loop(lambda: None)
    ring = guest.subscribe("robot/a/pwm", 10)
    guest.deliver(Inbox(ring), lambda sample: loop.stop(), loop)
    house.settle(guest)
    house.listener.close()
    house.fall()
    guest.read()
    os.unlink(house.place)
    house.listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    house.listener.bind(house.place)
    house.listener.listen()
    house.open()
    give_up = clock.now() + 30.0
    while not guest.is_open and clock.now() < give_up:
        house.loop.run(clock.now())
        loop.run(clock.now() + 0.01)
    assert guest.is_open
    guest.close()
    loop.close()


class Asker:
    """Somebody on the bus who asks."""

    def __init__(self, house: House) -> None:
        self.house = house
        self.answers: list[tuple[bytes, str]] = []
        self.refusals: list[str] = []

    def ask(self, payload: bytes = b"?", key: str = "robot/a/srv/x") -> None:
        said = Question(payload, "text/plain", lambda *it: self.answers.append(it), self.refusals.append)
        self.house.zenoh.takers[key](said)


def test_what_a_stranger_asks_is_answered_through_the_door(house: House) -> None:
    guest, asker = house.guest(), Asker(house)
    asked: list[Question] = []
    guest.serve("robot/a/srv/x", asked.append)
    house.settle(guest)
    asker.ask(b"one")
    asker.ask(b"two")
    house.settle(guest)
    assert [(said.payload, said.encoding) for said in asked] == [
        (b"one", "text/plain"),
        (b"two", "text/plain"),
    ]
    asked[1].answer(b"yes", "application/json;x")
    asked[0].refuse("not \ud800 today")
    house.settle(guest)
    assert asker.answers == [(b"yes", "application/json;x")]
    assert asker.refusals == ["not ? today"]
    asked[1].answer(b"again", "")
    house.settle(guest)
    assert len(asker.answers) == 1


def test_questions_come_no_faster_than_a_robot_can_bear(house: House) -> None:
    guest, asker = house.guest(), Asker(house)
    asked: list[Question] = []
    guest.serve("robot/a/srv/x", asked.append)
    house.settle(guest)
    for _ in range(1000):
        asker.ask()
    house.settle(guest)
    assert module.QUESTIONS_AT_ONCE <= len(asked) <= module.QUESTIONS_AT_ONCE + 10
    assert set(asker.refusals) == {module.TOO_MANY}
    assert len(asked) + len(asker.refusals) == 1000


def test_what_is_never_answered_is_forgotten(house: House) -> None:
    guest, asker = house.guest(), Asker(house)
    asked: list[Question] = []
    guest.serve("robot/a/srv/x", asked.append)
    house.settle(guest)
    asker.ask()
    house.settle(guest)
    house.host._guests[0].forget(clock.now() + module.UNANSWERED + 1)
    asked[0].answer(b"late", "")
    house.settle(guest)
    assert asker.answers == []
    assert house.host._guests[0]._questions == {}


def test_a_next_door_is_asked_too_and_an_answer_to_the_one_before_is_none(house: House) -> None:
    guest, asker = house.guest(), Asker(house)
    asked: list[Question] = []
    guest.serve("robot/a/srv/x", asked.append)
    house.settle(guest)
    asker.ask(b"before")
    house.settle(guest)
    house.fall()
    guest.read()
    asked[0].answer(b"to nobody", "")
    house.open()
    house.settle(guest)
    asked[0].answer(b"to nobody", "")
    house.settle(guest)
    assert asker.answers == []
    asker.ask(b"now")
    house.settle(guest)
    asked[0].answer(b"to nobody", "")
    asked[1].answer(b"yes", "")
    house.settle(guest)
    assert asker.answers == [(b"yes", "")]


def test_whoever_is_behind_a_door_asks_nobody(house: House) -> None:
    with pytest.raises(BusError, match="asks nobody"):
        house.guest().ask("robot/a/srv/x", b"", "", 1.0)
