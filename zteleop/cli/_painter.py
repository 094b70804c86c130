"""Draws the screen of whoever drives, and works out anew only what can look different."""

from collections import deque
from collections.abc import Sequence
from typing import Protocol

from msgspec.structs import replace

from zteleop.bus import clock
from zteleop.control.stick import Speeds
from zteleop.inputs import Drive
from zteleop.screen.dashboard import Dashboard
from zteleop.screen.render import render
from zteleop.screen.view import View
from zteleop.terminal.any_terminal import AnyTerminal

HEARD_WITHIN = 0.6
"""s in which a robot that is there is heard"""
MOTION_EVERY = 0.08
"""s between two pictures of one motion, at least: every second of twenty a second; what is asked or said is
shown at once"""
TRAIL = 400
TRAIL_STEP = 0.05
"""m"""


class Shown(Protocol):
    """What a screen shows of the device that drives."""

    drive: Drive

    @property
    def terminal(self) -> AnyTerminal:
        """Where the screen is."""

    @property
    def speeds(self) -> Speeds:
        """What a full stick means."""

    @property
    def about(self) -> Sequence[tuple[str, str]]:
        """What there is to say of it, by a short name: how sure it is what the operator holds."""

    @property
    def in_vain(self) -> str:
        """What to do, while the operator does something that counts for nothing."""

    @property
    def help(self) -> Sequence[tuple[str, str]]:
        """Which keys and buttons there are, and what each does, while somebody wants to see them."""

    def idle_left(self, now: float) -> float | None:
        """Return the seconds until neutral for want of an act; None when it is neutral already."""


class Painter:
    """One screen, of what is known from the start and what is seen."""

    def __init__(self, device: Shown, known: Dashboard) -> None:
        self._device = device
        self.known = known
        self._looks_until = clock.now() + HEARD_WITHIN
        self._trail: deque[tuple[float, float]] = deque(maxlen=TRAIL)
        self._lines: list[str] = []
        self._shown: object = None
        self._said: object = None
        self._drawn = 0.0

    def __call__(self, view: View) -> None:
        """Show what is seen now."""
        self._follow(view)
        device, terminal = self._device, self._device.terminal
        left = device.idle_left(view.now)
        dashboard = self.known._replace(
            drive=device.drive,
            speeds=device.speeds,
            seen=view,
            idle_left=left if left is None else round(left, 1),
            others=None if view.status is None and clock.now() < self._looks_until else self.known.others,
            about=device.about,
            in_vain=device.in_vain,
            keys=device.help,
        )
        size = terminal.size()
        said = (dashboard._replace(seen=View(), idle_left=None), *news(view), size)
        shown = (said, dashboard.idle_left, *visible(view), len(self._trail))
        is_due = said != self._said or view.now >= self._drawn + MOTION_EVERY
        if is_due and shown != self._shown:
            self._shown, self._said, self._drawn = shown, said, view.now
            page = dashboard._replace(trail=self._trail)
            self._lines = render(page, *size, unicode=terminal.unicode, color=terminal.color)
        terminal.draw(self._lines)

    def _follow(self, view: View) -> None:
        """Add where the robot is to its trail, when it has moved."""
        if view.odom is None:
            return
        place, trail = view.odom.pose.pose.position, self._trail
        if not trail or abs(place.x - trail[-1][0]) + abs(place.y - trail[-1][1]) > TRAIL_STEP:
            trail.append((place.x, place.y))


def news(view: View) -> tuple[View, object]:
    """Return what of a view is no mere motion: what is asked, and what the robot says of it."""
    status = view.status
    said = status and (status.state, status.why, status.operator, status.stops)
    return view._replace(now=0.0, status=None, odom=None, silence=0.0), said


def visible(view: View) -> tuple[View, object]:
    """Return what of a view can be seen: no times, and no counters."""
    status, odom = view.status, view.odom
    if status is not None:
        latency = round(status.latency, 2) if view.ours else 0.0  # it changes with each command
        status = replace(status, written=0.0, seq=0, refused=0, clamped=0, latency=latency)
    place = (odom.pose.pose, odom.twist.twist) if odom is not None else None
    return view._replace(now=0.0, status=status, odom=None), place
