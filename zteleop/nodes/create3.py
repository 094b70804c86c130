"""What a Create 3 has beside its wheels: buttons, bumpers, a battery, lights and notes, on its own topics."""

from functools import partial

from msgspec.structs import replace

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.subscription import Received
from zteleop.messages import (
    AudioNoteVector,
    BatteryState,
    Bool,
    DockStatus,
    HazardDetectionVector,
    Header,
    Imu,
    InterfaceButtons,
    LightringLeds,
    Log,
    SetBoolRequest,
    SetBoolResponse,
    StopStatus,
    WheelTicks,
    WheelVels,
)
from zteleop.sim.battery import LITHIUM_ION, Battery, BatterySettings
from zteleop.sim.create3.body import Create3
from zteleop.sim.create3.docking import is_docked, status
from zteleop.sim.create3.hazards import touch
from zteleop.sim.create3.interface_buttons import NAMES, Buttons, Name
from zteleop.sim.create3.lightring import Lightring
from zteleop.sim.create3.notes import Notes
from zteleop.sim.inertial import Inertial
from zteleop.sim.world import World

PACK = BatterySettings(
    cells=4,
    energy_wh=26.0,
    nominal_voltage=14.4,
    empty_voltage=12.0,
    full_voltage=16.8,
    technology=LITHIUM_ION,
)
AT_REST, PER_SPEED = 3.0, 30.0
"""W that it draws, and W more for each m/s of its wheels"""
NO_FARTHER = "it reverses no farther: it knows only the 15 cm of floor that it came from; drive forward first"
CHARGER = 20.0
"""W that its dock gives"""
SENSED, TOLD, NOTED = 0.05, 1.0, 0.05
"""s between what its wheels and bumpers say; its battery, buttons and brakes; and two looks at its notes"""


class Equipment:
    """All that a simulated Create 3 says and hears of itself; `world` is what its bumpers feel.

    `charge` is what its battery has at the start, 0 to 1.
    """

    def __init__(
        self,
        node: Node,
        robot: Create3,
        world: World | None,
        unit: Inertial | None = None,
        charge: float = 1.0,
    ) -> None:
        self._node = node
        self._robot = robot
        self._world = world
        self._unit = unit or Inertial()
        self._buttons = Buttons()
        self._switched: dict[Name, bool] = {}
        self._battery = Battery(replace(PACK, percentage=charge))
        self._lights = Lightring()
        self._notes = Notes()
        self._limited = False
        self._presses = node.publisher("interface_buttons", InterfaceButtons)
        self._listen()
        self._speak()

    def _listen(self) -> None:
        node = self._node
        for name in NAMES:
            node.service(name, SetBoolRequest, SetBoolResponse, partial(self._answer, name))
            node.subscription(name, Bool, partial(self._switch, name))
        node.subscription("cmd_lightring", LightringLeds, lambda heard: self._light(heard.message))
        node.subscription("cmd_audio", AudioNoteVector, lambda heard: self._notes.hear(heard.message))

    def _speak(self) -> None:
        """Say each thing as often as the robot does, or nearly so."""
        node = self._node
        ticks, speeds = node.publisher("wheel_ticks", WheelTicks), node.publisher("wheel_vels", WheelVels)
        hazards = node.publisher("hazard_detection", HazardDetectionVector)
        battery = node.publisher("battery_state", BatteryState)
        stops = node.publisher("stop_status", StopStatus)
        docks = node.publisher("dock_status", DockStatus)
        imus = node.publisher("imu", Imu)

        @node.every(SENSED)
        def sense() -> None:
            now, robot = clock.stamp(), self._robot
            header = Header(now, "base_link")
            ticks.publish(WheelTicks(header, *robot.wheels.ticks))
            speeds.publish(WheelVels(header, *robot.wheels.turning))
            felt = [*robot.hazards, *(touch(self._world).hazards if self._world else ())]
            hazards.publish(HazardDetectionVector(header, [hazard.message(now) for hazard in felt]))
            self._tell_limit(bool(robot.hazards))
            imus.publish(self._unit.measure(Header(now, "imu"), robot, SENSED))

        @node.every(TOLD)
        def tell() -> None:
            header, wheels = Header(clock.stamp(), "base_link"), self._robot.wheels
            dock = self._world.dock() if self._world else None
            if is_docked(dock):
                self._battery.charge(CHARGER, TOLD)
            else:
                self._battery.draw(AT_REST + PER_SPEED * sum(map(abs, wheels.speeds)) / 2, TOLD)
            docks.publish(status(header, dock))
            battery.publish(self._battery.state(header))
            stops.publish(StopStatus(header, wheels.speeds == (0.0, 0.0)))
            self._presses.publish(self._buttons.message(header.stamp))

        @node.every(NOTED)
        def play() -> None:
            self._notes.step(NOTED)
            while self._notes.started:
                note = self._notes.started.popleft()
                node.log.tell(Log.INFO, f"plays {note.frequency} Hz", "notes")

    def _tell_limit(self, is_reached: bool) -> None:
        """Say, once each time, why it does not reverse."""
        if is_reached and not self._limited:
            self._node.log.warn(NO_FARTHER)
        self._limited = is_reached

    def _answer(self, name: Name, request: SetBoolRequest) -> SetBoolResponse:
        """Press a button, or let it go, for whoever has no finger on the robot."""
        pressed = self._press(name, request.data)
        already = "" if pressed else " already"
        return SetBoolResponse(pressed, f"{name} is {'down' if request.data else 'up'}{already}")

    def _switch(self, name: Name, heard: Received[Bool]) -> None:
        """Follow a switch on some keyboard, which says once a second how it stands."""
        if self._switched.get(name, False) != (down := heard.message.data):
            self._switched[name] = down
            self._press(name, down)

    def _press(self, name: Name, down: bool) -> bool:
        """Press a button, or let it go; False when it is so already."""
        if not self._buttons.press(name, down, clock.stamp()):
            return False
        self._presses.publish(self._buttons.message(clock.stamp()))
        return True

    def _light(self, message: LightringLeds) -> None:
        """Show what is told, in words: a simulated ring is seen nowhere else yet."""
        self._lights.hear(message)
        if self._lights.told is None:
            self._node.log.tell(Log.INFO, "its lights are its own again", "own lights")
        else:
            colours = ", ".join(f"{led.red} {led.green} {led.blue}" for led in self._lights.told)
            words = f"its lights are {colours} (red green blue, from 4 o'clock on)"
            self._node.log.tell(Log.INFO, words, "lights")
