import pytest
from unit.bus.fakes import put

from zteleop.bus.names import Name
from zteleop.bus.presence import Endpoint
from zteleop.cli import watch
from zteleop.cli._listening import Arrival


def end(topic: str, node: str = "nose", robot: str = "abe", kind: str = "pub") -> Endpoint:
    return Endpoint(robot, kind, node, "pi-7", "std_msgs/msg/String", topic)


class Ears:
    """Who is there, and who was heard."""

    patient = True

    def __init__(self, *endpoints: Endpoint) -> None:
        self.there = list(endpoints)
        self.heard: dict[str, object] = {}
        self.nobody_at: list[str] = []

    def endpoints(self) -> list[Endpoint]:
        return self.there

    def unreached(self) -> list[str]:
        return self.nobody_at

    def hear(self, name: Name, handler: object) -> None:
        self.heard[str(name)] = handler


def arrive(ears: Ears, name: str, *times: float) -> None:
    for at in times:
        ears.heard[name](Arrival(at, put(b"x" * 500)))  # type: ignore[operator]


def test_a_table_says_what_is_said_how_often_and_how_long_ago() -> None:
    ears = Ears(end("odom"), end("odom", "twin"), end("log"), end("cmd_vel/keyboard"), end("why", kind="sub"))
    watched = watch.Watched(ears, None)
    watched.look()
    arrive(ears, "abe/odom", *(10.0 + 0.1 * number for number in range(11)))
    arrive(ears, "abe/log", 2.0)
    assert watched.lines(11.5) == [
        "topic         rate     bandwidth  last         said by     type",
        "/abe/cmd_vel                      nothing yet  nose        std_msgs/msg/String",
        "/abe/log                          9.5 s ago    nose        std_msgs/msg/String",
        "/abe/odom     10.0 Hz  5.0 kB/s   0.5 s ago    nose, twin  std_msgs/msg/String",
    ]


def test_only_what_was_said_lately_makes_a_rate() -> None:
    traffic = watch.Traffic()
    for at in (0.0, 0.001, 100.0, 101.0):
        traffic.hear(Arrival(at, put(b"x")))
    assert traffic.cells(101.0)[0] == "1.0 Hz"


def test_who_comes_is_heard_and_who_goes_is_shown_no_more() -> None:
    ears = Ears(end("odom"))
    watched = watch.Watched(ears, "abe")
    watched.look()
    ears.there = [end("why"), end("odom", robot="bob")]
    watched.look()
    assert [line.split()[0] for line in watched.lines(1.0)] == ["topic", "/abe/why"]
    assert set(ears.heard) == {"abe/odom", "abe/why"}
    ears.there = []
    watched.look()
    assert watched.lines(1.0) == ["nobody speaks for abe; start one with: zteleop demo, or zteleop actuator"]


def test_a_stranger_who_names_any_number_of_topics_or_none_that_is_a_name_ends_nothing() -> None:
    ears = Ears(end("a b"), end("**"), *(end(f"t{number}") for number in range(watch.MOST + 50)))
    watched = watch.Watched(ears, None)
    watched.look()
    assert 0 < len(ears.heard) <= watch.MOST
    assert any("not heard" in line for line in watched.lines(1.0))


def test_outside_a_terminal_one_table_stands_below_the_other(capsys: pytest.CaptureFixture[str]) -> None:
    watch.draw(["a", "\x1b[2Jb"])
    assert capsys.readouterr().out == "a\n\\u001b[2Jb\n\n"


def test_where_nobody_speaks_it_says_who_does_elsewhere_or_that_nobody_answers() -> None:
    ears = Ears(end("odom", robot="bob"))
    watched = watch.Watched(ears, "bop")
    watched.look()
    assert watched.lines(1.0) == ["nobody speaks for bop; heard here: bob; did you mean bob?"]
    ears.there, ears.nobody_at = [], ["tcp/pi:7447"]
    watched.look()
    (line,) = watched.lines(1.0)
    assert (
        line
        == "nobody speaks for bop; nothing answers at tcp/pi:7447: is the address right, and the robot on?"
    )
