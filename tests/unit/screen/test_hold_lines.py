from unit.screen.boards import dashboard

from zteleop.control.stick import Speeds
from zteleop.messages import DriveStatus, Twist, Vehicle
from zteleop.screen.hold_lines import hold_lines


def words(vehicle: Vehicle | None, columns: int = 80, **fields: object) -> list[list[str]]:
    board = dashboard("hold", vehicle, speeds=Speeds(0.2, 1.0), **fields)
    return ["".join(span.text for span in line.spans).split() for line in hold_lines(board, columns)]


def driving() -> DriveStatus:
    twists = Twist.planar(0.3, 0.5), Twist.planar(0.25, 0.4)
    return DriveStatus(
        "driving", "", "keyboard", "3fa2", *twists, [], 1, 0.0, [], "", "", 0, 0, 3.0, 0.06, "", 0
    )


def test_wanted_applied_and_what_a_full_stick_means(tank):
    assert words(tank, command=Twist.planar(0.3, -0.5), status=driving()) == [
        ["forward", "turning"],
        ["wanted", "+0.30", "m/s", "-0.50", "rad/s"],
        ["applied", "+0.25", "m/s", "+0.40", "rad/s"],
        ["full", "stick", "0.20", "m/s", "u/j", "1.00", "rad/s", "i/k"],
    ]


def test_a_narrow_window_has_the_numbers_alone(tank):
    assert words(tank, 20, command=Twist.planar(0.3, -0.5)) == [
        ["wanted", "+0.30", "-0.50"],
        ["applied", "-", "-"],
        ["speeds", "0.20", "1.00"],
    ]


def test_a_car_turns_by_its_lock(car):
    assert words(car)[3] == ["full", "stick", "0.20", "m/s", "u/j", "full", "lock"]
