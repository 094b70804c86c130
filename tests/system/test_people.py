"""Two people and one robot: who takes over, and what moves when somebody lets go."""

import signal
from collections.abc import Iterator

import pytest
from rig import NEUTRAL, Rig, Watch, every, hear, repeating, until

from zteleop.bus.publisher import Publisher
from zteleop.messages import DriveStatus, Pwm

LEFT, RIGHT = Pwm(390, 375), Pwm(350, 375)
LEFT_TICKS, RIGHT_TICKS = (390, 375), (350, 375)


@pytest.fixture
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("people")) as bench:
        bench.actuator()
        yield bench


def person(rig: Rig, source: str) -> Publisher[Pwm]:
    node = rig.node()
    rig.hear(node)
    return node.publisher("pwm", Pwm, source=source)


def stands(rig: Rig, ticks: tuple[int, int]) -> None:
    until(lambda: rig.ticks == ticks, f"{ticks} on the chip")


def test_whoever_pressed_while_another_drove_moves_nothing_when_that_one_lets_go(rig: Rig) -> None:
    first, second = person(rig, "keyboard"), person(rig, "keyboard")
    with repeating(lambda: first.publish(LEFT), 0.02):
        stands(rig, LEFT_TICKS)
        second.act()
        second.repeat(RIGHT)
    with repeating(lambda: second.repeat(RIGHT), 0.02):
        first.publish(Pwm(*NEUTRAL))
        stands(rig, NEUTRAL)
        second.act()
        for _ in every(0.005, 100):  # neither what was held, nor one more act of it
            assert rig.ticks == NEUTRAL
    second.publish(Pwm(*NEUTRAL))
    with repeating(lambda: second.publish(RIGHT), 0.02):
        stands(rig, RIGHT_TICKS)


def test_a_higher_priority_takes_over_at_once_and_nothing_is_mixed(rig: Rig) -> None:
    keyboard, web = person(rig, "keyboard"), person(rig, "web")
    statuses = rig.node().subscription("drive_status", DriveStatus)
    with repeating(lambda: keyboard.publish(LEFT), 0.02):
        stands(rig, LEFT_TICKS)
        with Watch(rig) as watch:
            with repeating(lambda: web.publish(RIGHT), 0.02):
                until(lambda: RIGHT_TICKS in watch.seen, "the page's command, by who watches")
                hear(statuses, lambda status: status.source == "web", "that the page drives")
            web.publish(Pwm(*NEUTRAL))
            stands(rig, LEFT_TICKS)
    assert watch.seen == {LEFT_TICKS, RIGHT_TICKS}


def test_a_lower_priority_waits_and_a_stop_holds_for_all(rig: Rig) -> None:
    keyboard, program = person(rig, "keyboard"), person(rig, "program")
    with (
        repeating(lambda: keyboard.publish(LEFT), 0.02),
        repeating(lambda: program.publish(RIGHT), 0.02),
    ):
        stands(rig, LEFT_TICKS)
        with Watch(rig) as watch:
            hear(
                rig.node().subscription("drive_status", DriveStatus), lambda s: s.source == "keyboard", "who"
            )
            rig.result("stop", *rig.bus_options())
            stands(rig, NEUTRAL)
        assert watch.seen <= {LEFT_TICKS, NEUTRAL}
        rig.result("stop", "--release", *rig.bus_options())
        for _ in every(0.005, 100):
            assert rig.ticks == NEUTRAL


def test_priorities_changed_by_a_restart_wait_for_whoever_begins_anew(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    with Rig(tmp_path_factory.mktemp("priorities")) as rig:
        robot = rig.actuator()
        keyboard, program = person(rig, "keyboard"), person(rig, "program")
        with (
            repeating(lambda: keyboard.publish(LEFT), 0.02),
            repeating(lambda: program.publish(RIGHT), 0.02),
        ):
            stands(rig, LEFT_TICKS)
            robot.signal(signal.SIGTERM)
            robot.ends()
            with (rig.folder / "config.toml").open("a") as config:
                config.write("[drive.sources.keyboard]\npriority = 10\n")
            rig.actuator().says(" is refused: it was moving before")
            for _ in every(0.005, 100):
                assert rig.ticks == NEUTRAL
        for who in (keyboard, program):
            who.publish(Pwm(*NEUTRAL))
        with (
            repeating(lambda: keyboard.publish(LEFT), 0.02),
            repeating(lambda: program.publish(RIGHT), 0.02),
        ):
            stands(rig, RIGHT_TICKS)
