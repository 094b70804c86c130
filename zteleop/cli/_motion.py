"""Drives a course from a shell, and tells what odometry saw of it."""

import argparse
from collections.abc import Callable
from math import degrees, inf

from zteleop.bus import clock
from zteleop.bus.escape import printable
from zteleop.bus.node import PROGRAM, Node
from zteleop.bus.subscription import Received
from zteleop.bus.topics import TOPICS
from zteleop.cli import _options
from zteleop.cli._outcome import Outcome, await_robot
from zteleop.control.command import STEERS_ONLY, steers_only
from zteleop.control.motion.course import Course
from zteleop.control.motion.pose import Pose2D, pose_of
from zteleop.control.motion.progress import Progress
from zteleop.control.motion.trail import Trail
from zteleop.control.report import in_dead_zone
from zteleop.control.unmet import too_tight
from zteleop.errors import BusError
from zteleop.messages import Odometry, Twist, Vehicle

PERIOD = TOPICS["cmd_vel"].every
ANSWERED_WITHIN = 3.0
"""s in which a robot that is there obeys, or says why it does not"""
SILENT = 1.0
"""s without a word of a robot's, after which nobody drives it on"""
WHO_DOES = "zteleop sim does of a simulated robot, zteleop odometry of any other"
SEEN_WITHIN = 2.0
"""s to wait for the first odometry"""
JUMP, FASTEST = 0.3, 5.0
"""m, and m more for each s since it was last seen, that no robot moves between two looks"""
STOOD = 1.0
"""s at the end of a course in which a robot that is told to move has not"""
STANDS_BELOW = 0.01
"""m/s at most, with which nobody gets anywhere"""
ASTRAY = 2.0
"""times as far as a course is, and a metre, after which a robot that is not there will never be"""
STANDS = 0.5
"""s after the last command in which it comes to rest, and is still looked at"""


class Motion:
    """One course of one robot: it ends with the course, or where the robot obeys no more."""

    def __init__(self, verb: str, node: Node, source: str = PROGRAM) -> None:
        """Wait for the robot; raises BusError when it does not answer."""
        self._node = node
        self._publisher = node.publisher("cmd_vel", Twist, source=source, wait=False)
        self._outcome = Outcome(verb, node, self._publisher)
        await_robot(verb, node, self._publisher)
        self._progress = Progress()
        self._trail = Trail()
        self._pose: Pose2D | None = None
        self._seen = clock.now()
        self._began = clock.now()
        self._lost = clock.now()
        self._why = ""
        self._anew = False
        """Its odometry has begun anew, or was put elsewhere: what it was driven by is no more."""
        node.subscription("odom", Odometry, self._see)

    @property
    def vehicle(self) -> Vehicle:
        """What is driven; raises BusError where it does not say."""
        heard = self._node.membership.heard()
        if not self._node.membership.until(lambda: heard.vehicle, ANSWERED_WITHIN) or not heard.vehicle:
            raise BusError(f"{self._node.robot} does not say what it is; is that its actuator?")
        return heard.vehicle

    def look(self) -> Pose2D:
        """Return where the robot is; raises BusError where nobody says so."""
        if not self._node.membership.until(lambda: self._pose, SEEN_WITHIN) or not self._pose:
            words = f"nobody says where {self._node.robot} is, on /{self._node.robot}/odom"
            raise BusError(f"{words}; {WHO_DOES}")
        return self._pose

    def drive(
        self, course: Course, tell: Callable[[Trail], str], *, by_sight: bool = True, most: float = inf
    ) -> None:
        """Drive to the end of a course and print what came of it; `by_sight` is only while it is seen.

        Whoever has driven `most` m and is not there goes astray.
        Raises BusError where it was not obeyed to the end.
        """
        over, stood, hint, asked = False, 0.0, "", Twist.planar()
        self._began = clock.now()

        @self._node.every(PERIOD)
        def step() -> None:
            nonlocal stood, hint, asked
            if over:
                return
            now = clock.now()
            self._why = self._hindrance(now, by_sight) or self._astray(most)
            twist = None if self._why else course.twist(self._pose or Pose2D(), now)
            if twist is None:
                stood, hint = min(self._trail.stood(now), now - self._began), self._hint(asked)
                self._node.stop()
            else:
                asked = twist
                self._outcome.note(twist)
                self._publisher.publish(twist)
                self._progress.ask(twist, PERIOD)

        try:
            self._node.spin()
        finally:
            over = True
            self._publisher.let_go()
            self._node.spin(STANDS)
            refused = self._publisher.refused or self._outcome.is_taken
            # Ctrl-C may have come before the word that it obeys; what another drove is not told as this one's
            if self._outcome.obeyed or (self._trail.way > 0 and not refused):
                print(printable(self._told(tell)), flush=True)
        self._outcome.check()
        if self._why:
            raise BusError(f"not driven to its end: {self._why}")
        if self._progress.is_asked and self._trail and self._trail.is_nowhere:
            raise BusError(f"{self._node.robot} did not move; {hint}")
        if stood > STOOD and self._progress.is_asked:
            raise BusError(f"{self._node.robot} stood for the last {stood:.1f} s of it; {hint}")

    def _astray(self, most: float) -> str:
        """Return what is wrong where it went much farther than it should have."""
        if self._trail.way <= most:
            return ""
        return f"it drove {self._trail.way:.1f} m and is not there; does it steer the way it is told?"

    def _hint(self, asked: Twist) -> str:
        """Return why it may stand."""
        heard, status = self._node.membership.heard().vehicle, self._outcome.status
        if steers_only(asked, heard):
            return STEERS_ONLY
        if status and status.slowed and status.max_speed < STANDS_BELOW:
            return status.slowed
        if heard and status and (dead := in_dead_zone(heard, status.pulses)):
            if status.slowed:
                return f"{dead}, as {status.slowed}"
            return f"{dead}: ask for {'less turn' if too_tight(asked, heard) else 'more'}"
        return "does something stand in its way?"

    def _told(self, tell: Callable[[Trail], str]) -> str:
        if self._trail:
            return tell(self._trail)
        unmeasured = f"nobody says where {self._node.robot} is: what it did was not measured"
        return f"{unmeasured} ({WHO_DOES})"

    def _hindrance(self, now: float, by_sight: bool) -> str:
        """Return why not to go on; nothing while there is no reason."""
        outcome, robot = self._outcome, self._node.robot
        if not outcome.lost:
            self._lost = now
        elif outcome.is_taken or now - self._lost > SILENT:  # whatever else is a moment's is begun anew
            return outcome.lost
        if not outcome.obeyed:
            waited = now - self._began > ANSWERED_WITHIN
            return self._publisher.refused or ("it does not obey" if waited else "")
        if now - outcome.heard_at > SILENT:
            return f"{robot} says nothing any more"
        if self._anew and by_sight:
            return f"where {robot} is was counted anew; say it again"
        if now - self._seen > SILENT:
            return f"nobody says any more where {robot} is" if by_sight else ""
        if self._trail and self._progress.is_stuck(self._trail, now):
            return f"{robot} hardly moves; {self._hint(Twist.planar())}"
        return ""

    def _see(self, received: Received[Odometry]) -> None:
        now, pose = clock.now(), pose_of(received.message)
        if self._pose and self._pose.distance(pose.x, pose.y) > JUMP + FASTEST * (now - self._seen):
            self._anew = True
            return
        self._pose, self._seen = pose, now
        self._trail.add(pose, now)


def add_figure(parser: argparse.ArgumentParser) -> None:
    """Add how a figure is driven."""
    parser.add_argument("--right", action="store_true", help="clockwise (default: to the left)")
    parser.add_argument(
        "--speed", type=_options.measure("speed"), help="such as 0.2m/s (default: an easy one)"
    )


def announce(node: Node, twist: Twist, seconds: float | None) -> None:
    """Say what is published, as `zteleop pub` would take it, and for how long; None is until Ctrl-C."""
    values = f"{{linear: {{x: {twist.linear.x:.3g}}}, angular: {{z: {twist.angular.z:.3g}}}}}"
    lasts = "until Ctrl-C" if seconds is None else f"for {seconds:.3g} s, or until Ctrl-C"
    print(f"says /{node.robot}/cmd_vel Twist '{values}', {1 / PERIOD:.0f} times a second {lasts}", flush=True)


def went(trail: Trail) -> str:
    """Return how far it went and how far it turned, and on which circle, if on one."""
    if trail.is_nowhere:
        return "went nowhere"
    is_arc = trail.way > 0.05 and abs(degrees(trail.turned)) >= 20
    radius = trail.radius() if is_arc else None
    bend = f", on a circle of {radius:.2f} m" if radius else ""
    back = " backwards" if trail.ahead < -trail.way / 2 else ""
    turn = f"turned {degrees(trail.turned):+.0f} deg"
    return f"went {trail.way:.2f} m{back} and {turn} in {trail.seconds:.1f} s{bend}"
