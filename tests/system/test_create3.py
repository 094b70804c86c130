"""A simulated Create 3: the figures, buttons, bumpers, lights and notes of the real one."""

import re
import signal
from collections.abc import Iterator
from math import atan2
from pathlib import Path

import pytest
from rig import Process, Rig, hear, until

from zteleop.bus.node import Node
from zteleop.control.create3 import FULL_SPEED, MAX_TURN, SAFE_SPEED, WHEEL_RADIUS
from zteleop.messages import (
    BatteryState,
    DockStatus,
    HazardDetectionVector,
    Imu,
    InterfaceButtons,
    Odometry,
    StopStatus,
    WheelTicks,
    WheelVels,
)

ROOM = """
[[walls]]
points = [[1.0, -3.0], [1.0, 3.0]]
"""
BACKUP_LIMIT, BUMP = 0, 1
CHARGING, FULL = 1, 4
REST = (368, 368)
"""ticks, right and left: 1500 us"""


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("create3")) as bench:
        (bench.folder / "room.toml").write_text(ROOM)
        bench.actuator("--vehicle", "create3")
        yield bench


@pytest.fixture
def sim(rig: Rig) -> Iterator[Process]:
    """A robot that was just switched on, a metre before a wall."""
    process = rig.join("sim", "create3", "--scene", "room.toml")
    process.says("moves bench, a simulated create3, by the pulses in ")
    process.says("is heard")
    yield process
    process.close()


COURSE = (
    "{header: {stamp: {sec: 0, nanosec: 0}, frame_id: ''}, "
    "twist: {linear: {x: 0.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 0.5}}}"
)
"""as the course types it"""


@pytest.mark.usefixtures("sim")
def test_the_line_of_the_course_turns_it(rig: Rig, node: Node) -> None:
    odoms = node.subscription("odom", Odometry)
    typed = ["pub", "-r", "4", "/bench/cmd_vel_stamped", "geometry_msgs/msg/TwistStamped", COURSE]
    says = rig.join("topic", *typed)
    hear(odoms, lambda seen: seen.twist.twist.angular.z == pytest.approx(0.5, abs=0.02), "a left turn")
    says.signal(signal.SIGINT)
    assert says.ends() == 130, says.text
    hear(odoms, lambda seen: seen.twist.twist.angular.z == 0.0, "it rests")


def test_with_its_safety_overridden_it_is_faster_and_reverses_as_far_as_it_is_told(tmp_path: Path) -> None:
    with Rig(tmp_path, "full") as bench:
        bench.actuator("--vehicle", "create3_full")
        bench.join("sim", "create3_full").says("is heard")
        odoms = bench.node("listener").subscription("/full/odom", Odometry)
        for asked, speed in (("-0.4m/s", -0.4), ("0.7m/s", FULL_SPEED)):
            driving = bench.join("drive", asked)
            until(lambda: near(odoms.newest(), speed), f"it does {speed} m/s")  # noqa: B023
            driving.signal(signal.SIGINT)
            driving.ends()


def near(odom: Odometry | None, speed: float) -> bool:
    return bool(odom) and odom.twist.twist.linear.x == pytest.approx(speed, abs=0.01)


@pytest.fixture(scope="module")
def node(rig: Rig) -> Node:
    return rig.node("listener")


def ask(rig: Rig, *words: str) -> str:
    verb, *rest = words
    result = rig.result(*verb.split(), *rig.bus_options(), *rest)
    assert result.returncode == 0, result.stderr
    return str(result.stdout)


@pytest.mark.parametrize(
    ("asked", "speed", "turn"),
    [
        ("0.1m/s", 0.1, 0.0),
        ("0.7m/s", SAFE_SPEED, 0.0),
        ("5.5rad/s", 0.0, MAX_TURN),
    ],
)
@pytest.mark.usefixtures("sim")
def test_it_is_as_fast_as_it_is_told_up_to_its_own_bounds(
    rig: Rig, node: Node, asked: str, speed: float, turn: float
) -> None:
    odoms = node.subscription("odom", Odometry)
    drive = rig.join("drive", asked, "--for", "2s")
    hear(
        odoms,
        lambda odom: (
            (odom.twist.twist.linear.x, odom.twist.twist.angular.z) == pytest.approx((speed, turn), abs=0.01)
        ),
        f"{speed} m/s and {turn} rad/s",
    )
    assert drive.ends() == 0


@pytest.mark.usefixtures("sim")
def test_what_is_too_fast_keeps_its_radius(rig: Rig) -> None:
    said = ask(rig, "drive", "0.3m/s", "0.5rad/s", "--for", "3s")
    circle = re.search(r"on a circle of (\d\.\d\d) m", said)
    assert circle
    assert float(circle[1]) == pytest.approx(0.6, abs=0.02)


@pytest.mark.usefixtures("sim")
def test_a_button_is_pressed_by_whoever_has_no_finger_on_it(rig: Rig, node: Node) -> None:
    presses = node.subscription("interface_buttons", InterfaceButtons)
    held = rig.join("buttons")
    held.says("idle: nobody drives")
    said = ask(rig, "service call", "button_1", "std_srvs/srv/SetBool", "{data: true}")
    assert "success=True, message='button_1 is down'" in said
    hear(presses, lambda seen: seen.button_1.is_pressed and not seen.button_2.is_pressed, "the left one down")
    first = hear(
        presses, lambda seen: seen.button_1.last_pressed_duration.sec >= 1, "it is held for a second"
    )
    assert first.button_1.last_start_pressed_time.sec > 0
    again = ask(rig, "service call", "button_1", "std_srvs/srv/SetBool", "{data: true}")
    assert "success=False, message='button_1 is down already'" in again
    ask(rig, "service call", "button_1", "std_srvs/srv/SetBool", "{data: false}")
    up = hear(presses, lambda seen: not seen.button_1.is_pressed, "it is up")
    assert up.button_1.last_pressed_duration.sec >= 1
    until(lambda: rig.ticks == REST, "rest")
    held.close()


@pytest.mark.usefixtures("sim")
def test_what_it_runs_into_is_felt_by_the_bumper_that_is_there(rig: Rig, node: Node) -> None:
    hazards = node.subscription("hazard_detection", HazardDetectionVector)
    stops = node.subscription("stop_status", StopStatus)
    drive = rig.join("drive", "0.3m/s", "--for", "4s")
    felt = hear(hazards, lambda seen: seen.detections, "a bump")
    assert [(one.type, one.header.frame_id) for one in felt.detections] == [(BUMP, "bump_front_center")]
    drive.ends()
    hear(stops, lambda seen: seen.is_stopped, "it stands")


def test_it_does_not_reverse_onto_floor_that_it_never_saw(rig: Rig, node: Node, sim: Process) -> None:
    hazards = node.subscription("hazard_detection", HazardDetectionVector)
    drive = rig.join("drive", "-0.2m/s", "--for", "2s")
    felt = hear(hazards, lambda seen: seen.detections, "the limit")
    assert felt.detections[0].type == BACKUP_LIMIT
    sim.says("it reverses no farther: it knows only the 15 cm of floor that it came from")
    assert drive.ends() == 1
    assert drive.lines[-2] == "went nowhere"
    assert "bench did not move; does something stand in its way?" in drive.lines[-1]


@pytest.mark.usefixtures("sim")
def test_its_wheels_and_its_battery_say_what_they_do(rig: Rig, node: Node) -> None:
    speeds, ticks = node.subscription("wheel_vels", WheelVels), node.subscription("wheel_ticks", WheelTicks)
    batteries = node.subscription("battery_state", BatteryState)
    drive = rig.join("drive", "0.2m/s", "--for", "2s")
    turning = pytest.approx(0.2 / WHEEL_RADIUS, abs=0.1)
    hear(speeds, lambda seen: (seen.velocity_left, seen.velocity_right) == (turning, turning), "0.2 m/s")
    assert drive.ends() == 0
    hear(ticks, lambda seen: seen.ticks_left > 500 and seen.ticks_left == seen.ticks_right, "0.3 m or so")
    battery = hear(batteries, lambda seen: seen.percentage < 1.0, "what was drawn")
    assert 16.0 < battery.voltage < 16.8
    assert len(battery.cell_voltage) == 4


def test_notes_and_lights_are_told(rig: Rig, sim: Process) -> None:
    note = "{frequency: 440, max_runtime: {sec: 0, nanosec: 300000000}}"
    ask(rig, "pub", "cmd_audio", "AudioNoteVector", f"{{notes: [{note}], append: false}}", "--once")
    sim.says("plays 440 Hz")
    led = "{red: 255, green: 0, blue: 0}"
    leds = f"{{leds: [{', '.join([led] * 6)}], override_system: true}}"
    ask(rig, "pub", "cmd_lightring", "LightringLeds", leds, "--once")
    sim.says("its lights are 255 0 0, 255 0 0")
    ask(rig, "pub", "cmd_lightring", "LightringLeds", leds.replace("true", "false"), "--once")
    sim.says("its lights are its own again")


@pytest.mark.usefixtures("sim")
def test_it_feels_how_it_turns_and_knows_where_it_looks(rig: Rig, node: Node) -> None:
    imus = node.subscription("imu", Imu)
    still = hear(imus, lambda felt: felt.header.frame_id == "imu", "an inertial unit")
    assert still.linear_acceleration.z == pytest.approx(9.81)
    drive = rig.join("drive", "0m/s", "1rad/s", "--for", "1s")
    hear(imus, lambda felt: felt.angular_velocity.z == pytest.approx(1.0, abs=0.05), "a turn to the left")
    assert drive.ends() == 0
    hear(imus, lambda felt: abs(felt.angular_velocity.z) < 0.01, "it stands")
    turned = hear(imus, lambda felt: felt.orientation.z > 0, "another heading")
    assert 0.5 < 2 * atan2(turned.orientation.z, turned.orientation.w) < 1.5


DOCK = """
dock = { x = 0.0, y = 0.0 }
"""


def test_it_charges_in_its_dock_until_it_drives_out(rig: Rig, node: Node) -> None:
    (rig.folder / "dock.toml").write_text(DOCK)
    docks = node.subscription("dock_status", DockStatus)
    batteries = node.subscription("battery_state", BatteryState)
    sim = rig.join("sim", "create3", "--scene", "dock.toml")
    sim.says("is heard")
    hear(docks, lambda seen: seen.is_docked and seen.dock_visible, "it is docked")
    hear(batteries, lambda seen: seen.power_supply_status in (CHARGING, FULL), "it charges, or is full")
    ask(rig, "drive", "0.2m/s", "--for", "2s")
    hear(docks, lambda seen: not seen.is_docked and not seen.dock_visible, "the dock is behind it")
    hear(batteries, lambda seen: seen.current < 0, "it discharges")
    sim.close()


@pytest.mark.usefixtures("sim")
def test_a_key_of_an_operator_presses_a_button_and_lets_it_go(rig: Rig, node: Node) -> None:
    presses = node.subscription("interface_buttons", InterfaceButtons)
    (rig.folder / "keys.toml").write_text('[keys]\n1 = "toggle button_1"\n')
    screen = rig.keyboard("--config", "keys.toml")
    screen.shows(" idle", "button_1 off")
    screen.type("1")
    hear(presses, lambda seen: seen.button_1.is_pressed and not seen.button_2.is_pressed, "it is down")
    said = ask(rig, "service call", "button_1", "std_srvs/srv/SetBool", "{data: true}")
    assert "button_1 is down already" in said
    hear(presses, lambda seen: seen.button_1.last_pressed_duration.sec >= 1, "no repeat of a key any more")
    screen.type("1")
    hear(presses, lambda seen: not seen.button_1.is_pressed, "it is up")
    ask(rig, "service call", "button_1", "std_srvs/srv/SetBool", "{data: true}")
    hear(presses, lambda seen: seen.button_1.is_pressed, "somebody else presses it")
    hear(
        presses,
        lambda seen: seen.button_1.is_pressed and seen.button_1.last_pressed_duration.sec >= 2,
        "what is said once a second, that the switch is off, lets nobody's button go",
    )
    screen.type("q")
    assert screen.ends() == 0
