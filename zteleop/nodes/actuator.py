"""Commands in, pulses out: the only process that moves the robot."""

import secrets

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.subscription import Received
from zteleop.bus.topics import TOPICS
from zteleop.control.drive import Drive, DriveSettings
from zteleop.control.report import describe, status
from zteleop.drivers import PulseDriver
from zteleop.errors import MessageError
from zteleop.messages import Beat, DriveStatus, Int16MultiArray, Message, Pwm, Twist, TwistStamped, Vehicle

PERIOD = 0.02
AT_MOST_EVERY = 0.005
IN_A_ROW = 4
TELL_EVERY = 0.05
DESCRIBE_EVERY = 0.2


class Actuator:
    """Steps the drive on arrival, for latency, and on a clock, because only a clock hears silence."""

    def __init__(self, node: Node, settings: DriveSettings, driver: PulseDriver) -> None:
        self._node, self._settings, self._driver = node, settings, driver
        self._neutral_us = {servo.channel: servo.neutral_us for servo in settings.servos.values()}
        driver.start(self._neutral_us)
        self._drive = Drive(settings, driver.tick_us, _epoch(), clock.now())
        self._step = self._drive.step(clock.now())
        self._written = clock.now()
        self._beats = node.publisher("beat", Beat)
        self._statuses = node.publisher("drive_status", DriveStatus)
        self._vehicles = node.publisher("vehicle", Vehicle)
        self._answered = float("-inf")
        self._soon = node.alarm(self._answer)

    def run(self) -> None:
        """Drive until the node is stopped, then leave the chip at neutral."""
        try:
            for source in self._settings.known_sources:
                for topic in ("cmd_vel", "pwm"):
                    self._node.subscription(f"{topic}/{source}", TOPICS[topic].types, self._receive)
            self._node.every(PERIOD)(self._advance)
            self._node.every(TELL_EVERY)(self._tell)
            self._node.every(DESCRIBE_EVERY)(self._describe)
            self._node.log.info(f"obeys {self._node.robot}")
            self._node.spin()
        finally:
            self._driver.write(self._neutral_us)
            self._driver.close()

    def _receive(self, received: Received[Message]) -> None:
        """Judge a command; when it counts, step at once, or as soon as the last answer is old enough."""
        now, source = received.at, received.source
        self._notice_pause(now)
        try:
            command = to_command(received.message)
        except MessageError as error:
            self._node.log.warn(f"{received.key}: dropped: {error}", received.key)
            return
        refusal = self._drive.receive(source, command, received.proof, now)
        if refusal:
            self._node.log.warn(f"{received.key} is refused: {refusal}", f"{source} {refusal}")
        else:
            self._soon.due = max(now, self._answered + AT_MOST_EVERY)

    def _answer(self) -> None:
        """Step for what has arrived, 200 times a second on the average, a few in a row at once."""
        self._answered = max(self._answered + AT_MOST_EVERY, clock.now() - (IN_A_ROW - 1) * AT_MOST_EVERY)
        self._advance()

    def _advance(self) -> None:
        """Decide the pulses of now and write them."""
        now = clock.now()
        self._notice_pause(now)
        before, self._step = self._step, self._drive.step(now)
        self._driver.write(self._step.pulse_us)
        self._written = clock.now()
        if self._step.state != before.state:
            self._node.log.info(f"{self._step.state}: {self._step.why}")
            self._tell_status()

    def _notice_pause(self, now: float) -> None:
        """Begin a new epoch when this process itself was stopped: what it knows is from before."""
        if self._drive.late(now):
            self._node.log.warn("this process was stopped for a while; whoever drove must let go first")
            self._drive.restart(_epoch(), now)

    def _tell(self) -> None:
        self._beats.publish(Beat(self._drive.gate.epoch, clock.now()))
        self._tell_status()

    def _tell_status(self) -> None:
        self._statuses.publish(status(self._drive, self._step, self._written))

    def _describe(self) -> None:
        self._vehicles.publish(describe(self._settings, self._driver.tick_us))


def to_command(message: Message) -> Twist | Pwm:
    """Return what a message commands; raises MessageError when it commands nothing."""
    if isinstance(message, TwistStamped):
        return message.twist
    if isinstance(message, Int16MultiArray):
        if len(message.data) < 2:
            raise MessageError(f"expected [steering, throttle], found {message.data}")
        return Pwm(message.data[0], message.data[1])
    if isinstance(message, Twist | Pwm):
        return message
    raise MessageError(f"a {type(message).__name__} commands nothing")


def _epoch() -> int:
    return secrets.randbits(53)
