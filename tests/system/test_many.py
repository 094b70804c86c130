"""Several robots, actuators and operators on one bus."""

import os
import re
import signal
import socket
from collections.abc import Iterator

import pytest
from rig import NEUTRAL, Rig, Watch, every, hear, repeating, until

from zteleop.bus.publisher import Publisher
from zteleop.messages import DriveStatus, Log, Pwm

FORWARD, PATTERN = Pwm(390, 380), (390, 380)


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("many")) as bench:
        bench.actuator()
        yield bench


@pytest.fixture(scope="module")
def other(tmp_path_factory: pytest.TempPathFactory, rig: Rig) -> Iterator[Rig]:
    """Another robot with another actuator on the same bus."""
    with Rig(tmp_path_factory.mktemp("other"), "other") as bench:
        bench.actuator("--connect", rig.endpoint)
        yield bench


@pytest.fixture(scope="module")
def first(rig: Rig) -> Publisher[Pwm]:
    """Who operates the first robot."""
    return operator(rig)


def operator(rig: Rig, robot: str | None = None) -> Publisher[Pwm]:
    node = rig.node(robot=robot)
    rig.hear(node)
    return node.publisher("pwm", Pwm, source="keyboard")


def stands(rig: Rig, steering: int, throttle: int) -> None:
    until(lambda: rig.ticks == (steering, throttle), f"{steering}, {throttle} on the chip")


def test_a_second_actuator_of_one_robot_says_who_has_it_and_ends(rig: Rig, first: Publisher[Pwm]) -> None:
    with repeating(lambda: first.publish(FORWARD), 0.02):
        stands(rig, *PATTERN)
        with Watch(rig) as watch:
            second = rig.join("actuator", "--config", os.devnull)
            assert second.ends() == 1
        watch.saw_only(PATTERN)
    (line,) = second.lines
    assert line.startswith(f"zteleop actuator: robot bench has an actuator already: {socket.gethostname()}-")
    assert line.endswith("; stop it, or say --robot")
    stands(rig, *NEUTRAL)


def test_a_second_actuator_of_one_chip_says_who_has_it_and_ends(rig: Rig) -> None:
    second = rig.run("actuator", "--robot", "another", "--no-multicast-scouting")
    assert second.ends() == 1
    (line,) = second.lines
    words = rf"the simulated chip {rig.chip} is driven by process (\d+) already; stop it first \(.*kill \1\)$"
    assert re.search(words, line)
    assert rig.ticks == NEUTRAL


def test_robots_of_different_names_do_not_hear_each_other(
    rig: Rig, other: Rig, first: Publisher[Pwm]
) -> None:
    second = operator(other)
    with repeating(lambda: first.publish(FORWARD), 0.02), Watch(other) as watch:
        stands(rig, *PATTERN)
    stands(rig, *NEUTRAL)
    assert watch.seen == {NEUTRAL}
    with repeating(lambda: second.publish(FORWARD), 0.02), Watch(rig) as watch:
        stands(other, *PATTERN)
    assert watch.seen == {NEUTRAL}
    second.let_go()  # else it keeps its place for a while, and whoever begins meanwhile must begin anew


def test_any_robot_on_the_bus_can_be_driven_from_anywhere_on_it(rig: Rig, other: Rig) -> None:
    far = operator(rig, robot="other")
    with repeating(lambda: far.publish(FORWARD), 0.02), Watch(rig) as watch:
        stands(other, *PATTERN)
    assert watch.seen == {NEUTRAL}


def test_of_several_robots_one_must_be_named(rig: Rig, other: Rig) -> None:
    bus = ["--no-multicast-scouting", "--connect", rig.endpoint, "--connect", other.endpoint]
    both = rig.result("list", *bus).stdout.splitlines()
    assert {"/bench/beat", "/other/beat"} <= set(both)
    result = rig.result("echo", "beat", "--once", *bus)
    assert (result.returncode, result.stdout) == (1, "")
    assert result.stderr == "zteleop echo: 2 robots are on the bus: bench, other; say --robot NAME\n"
    assert rig.result("echo", "/other/beat", "--once", *bus).returncode == 0


def test_who_joins_late_is_told_who_drives_and_waits_for_his_turn(rig: Rig, first: Publisher[Pwm]) -> None:
    with repeating(lambda: first.publish(FORWARD), 0.02):
        stands(rig, *PATTERN)
        late = rig.node("late")
        statuses = late.subscription("drive_status", DriveStatus)
        status = hear(statuses, lambda status: True, "who drives")
        assert (status.state, status.source, status.operator) == ("driving", "keyboard", first.sender)
        rig.hear(late)
        second, logs = late.publisher("pwm", Pwm, source="keyboard"), late.subscription("log", Log)
        with Watch(rig) as watch, repeating(lambda: second.publish(Pwm(300, 370)), 0.02):
            hear(logs, lambda log: "another sender drives this source" in log.msg, "a refusal")
        watch.saw_only(PATTERN)
    stands(rig, *NEUTRAL)


def test_an_actuator_that_starts_again_under_a_stream_waits_until_it_lets_go(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    with Rig(tmp_path_factory.mktemp("again")) as rig:
        actuator = rig.actuator()
        publisher = operator(rig)
        with repeating(lambda: publisher.publish(FORWARD), 0.02):
            stands(rig, *PATTERN)
            actuator.signal(signal.SIGKILL)
            actuator.ends()
            again = rig.actuator()
            again.says(" is refused: it was moving before")
            for _ in every(0.005, 100):
                assert rig.ticks == NEUTRAL
        publisher.publish(Pwm(*NEUTRAL))
        with repeating(lambda: publisher.publish(FORWARD), 0.02):
            stands(rig, *PATTERN)


def test_a_killed_node_is_listed_no_longer(rig: Rig) -> None:
    sender = rig.join("pub", "soil", "String", "{data: dry}")
    hearer = rig.join("echo", "soil")
    hearer.says("dry")
    hearer.signal(signal.SIGINT)  # who hears a topic keeps it on the list
    assert hearer.ends() == 130

    def listed() -> bool:
        return "/bench/soil" in rig.result("list", *rig.bus_options()).stdout.splitlines()

    until(listed, "a list with the topic")
    sender.signal(signal.SIGKILL)
    sender.ends()
    assert not listed()


def test_a_strangers_token_keeps_no_robot_from_starting(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Anybody on the bus may hold a place; only a watchdog says what it sees."""
    with (
        Rig(tmp_path_factory.mktemp("stranger")) as rig,
        Rig(tmp_path_factory.mktemp("hall"), "hall") as hall,
    ):
        hall.actuator()
        stranger = hall.session()
        token = stranger.liveliness().declare_token(f"robot/{rig.robot}/live/node/watchdog/a-stranger-1")
        actuator = rig.actuator("--connect", hall.endpoint)
        actuator.says(
            "a-stranger-1 holds the place of this robot's watchdog and says nothing; it is passed over"
        )
        publisher = operator(rig)
        with repeating(lambda: publisher.publish(FORWARD), 0.02):
            stands(rig, *PATTERN)
        token.undeclare()
