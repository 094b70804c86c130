"""From an input device to commands: what the stick asks for, at each act and 20 times a second."""

from collections.abc import Callable
from typing import NamedTuple

from zteleop.bus import clock
from zteleop.bus.lane.call import Call
from zteleop.bus.node import Node
from zteleop.bus.topics import TOPICS
from zteleop.control.stick import Stick, to_pwm, to_twist
from zteleop.errors import BusError, ConfigError
from zteleop.inputs import Input, Wish
from zteleop.messages import Pwm, Twist, Vehicle
from zteleop.nodes.sight import Sight
from zteleop.nodes.speed_parameters import offer_speeds
from zteleop.nodes.stop_request import REPEAT, Stopping, person
from zteleop.nodes.times import ACT_TO_BUS, Times
from zteleop.nodes.voice import Voice
from zteleop.screen.view import View

PERIOD = TOPICS["cmd_vel"].every
AT_REST = 4 * PERIOD
"""s between two looks while nobody drives and no key wakes it: a screen at which nobody sits costs little"""
NEUTRALS = 3
LATE = 0.5
"""s between two looks at the device, after which this process knows that it was stopped itself."""
LEAVING = f"ends when the stop has been said for {REPEAT:g} s, to whoever comes late"
NEWS = 5.0
"""s that the answer to a stop or a release is shown."""
SHOW_AFTER = 0.004  # drawing at once would hold up what was just said on its way out


class Asked(NamedTuple):
    """What the operator asked for last."""

    stick: Stick
    command: Twist | Pwm | None = None


class Teleop:
    """One operator, one device, one robot. An idle device says neutral three times, then nothing."""

    def __init__(
        self,
        node: Node,
        device: Input,
        source: str,
        vehicle: Vehicle,
        show: Callable[[View], None],
        lane: Call | None = None,
    ) -> None:
        self._node = node
        self._device = device
        self._vehicle = vehicle
        self._show = show
        self._sight = Sight(node)
        self._voice = Voice(node, device, source)
        self._stopping = Stopping(node, person(), lane=lane)
        self._looked = clock.now()
        self._neutrals = 0
        self._asked = Asked(Stick())
        self._times = Times(node, lambda: self._voice.name)
        self._picture = node.membership.loop.alarm(self._draw)
        self._clock = node.membership.loop.every(AT_REST, self.obey)
        device.fit(vehicle)
        offer_speeds(node, device)

    def run(self) -> None:
        """Drive until the operator has enough; the last word is neutral.

        Raises BusError when he leaves and nobody has acknowledged his stop.
        """
        file = self._device.fileno()
        if file is not None:
            self._node.membership.loop.watch(file, self.obey)
        try:
            self._node.spin()
        finally:
            self._voice.say(None, self._vehicle)
        if self._stopping.unanswered:
            raise BusError(self._stopping.words)

    @property
    def _is_busy(self) -> bool:
        """Something is asked for, or just was, or the robot is driven by somebody else."""
        status = self._sight.status
        driven = status is not None and status.state == "driving"
        stops = self._stopping.state == "pending" or self._stopping.repeats(clock.now())
        return driven or stops or self._asked.stick.deadman or self._neutrals > 0

    def obey(self) -> None:
        """Take in what the operator did, say what the stick asks for, and soon show it."""
        now = clock.now()
        self._notice_robot(now)
        if acted := self._device.read(now):
            self._voice.act()
        self._notice_pause(now)
        self._pass_on_wish(now)
        stick = self._device.stick(now)
        command = self._command(stick)
        rested, self._device.rested = self._device.rested, False
        if rested and command and self._asked.command:  # let go and pressed again, before anybody looked
            self._voice.say(None, self._vehicle)
        if command:
            self._neutrals = NEUTRALS
        if self._neutrals:
            self._neutrals -= command is None
            self._voice.say(command, self._vehicle)
            if acted:
                self._times.note(ACT_TO_BUS, clock.now() - now)
        self._asked = Asked(stick, command)
        self._picture.ring_at(now + SHOW_AFTER)
        self._clock.pace(PERIOD if self._is_busy else AT_REST, now)
        if self._device.finished and self._stopping.state != "pending" and not self._stopping.repeats(now):
            self._node.stop()

    def _draw(self) -> None:
        self._show(self._view(clock.now()))

    def _command(self, stick: Stick) -> Twist | Pwm | None:
        if self._device.drive == "step":
            return to_pwm(stick, self._vehicle)
        return to_twist(stick, self._device.speeds, self._vehicle)

    def _notice_pause(self, now: float) -> None:
        """Drop what was typed while this process stood still: it was meant for then. A stop counts."""
        then, self._looked = self._looked, now
        if now - then > LATE:
            self._device.reset(now)
            if self._device.wish is Wish.RELEASE:
                self._device.wish = None

    def _notice_robot(self, now: float) -> None:
        """Take in what the robot says; after what ends a claim, the next act begins from neutral."""
        if self._sight.look(now):
            if self._asked.stick.deadman:
                self._sight.note_loss(now)
            self._device.reset(now)
        if (vehicle := self._sight.vehicle) and vehicle != self._vehicle:
            self._refit(vehicle, now)
        self._stopping.heed(self._sight.news, now)
        self._stopping.listen(now)

    def _pass_on_wish(self, now: float) -> None:
        wish, self._device.wish = self._device.wish, None
        if wish is Wish.STOP:
            self._stopping.engage(now, f"at {self._voice.name}")
            self._device.reset(now)
        elif wish is Wish.RELEASE:
            self._stopping.release(self._sight.status, now)

    def _refit(self, vehicle: Vehicle, now: float) -> None:
        """Learn another calibration; what this device cannot drive is said, and never driven."""
        try:
            self._device.fit(vehicle)
            self._vehicle = vehicle
        except ConfigError as error:
            self._device.reset(now)
            self._node.log.warn(f"{self._node.robot} cannot be driven like this: {error}")

    def _view(self, now: float) -> View:
        publisher = self._voice.publisher
        status, unmanned = self._sight.status, self._sight.unmanned
        ours = status is not None and status.operator == publisher.sender
        return View(
            now=now,
            vehicle=self._vehicle,
            stick=self._asked.stick,
            command=self._asked.command,
            status=None if unmanned else status,
            ours=ours,
            refused=publisher.refused,
            odom=self._sight.odom(now),
            odom_lost=self._sight.odom_lost,
            unmanned=unmanned,
            silence=round(self._sight.silence(now), 1),
            note=self._news(now),
            alarm=self._stopping.unanswered,
        )

    def _news(self, now: float) -> str:
        """Return what the robot answers to a stop or a release, for a while; else the latest of the log."""
        log, asking = self._sight.log(now), self._stopping
        pending = asking.state == "pending" or asking.unanswered
        if self._device.finished and not pending:
            return LEAVING
        is_news = now - asking.ended < NEWS and not asking.is_over
        return asking.words if pending or is_news else log
