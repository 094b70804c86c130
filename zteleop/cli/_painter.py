"""Draws the keyboard's screen, and works out anew only what can look different."""

from collections import deque

from msgspec.structs import replace

from zteleop.bus import clock
from zteleop.inputs.keyboard import Keyboard
from zteleop.screen.dashboard import Dashboard
from zteleop.screen.render import render
from zteleop.screen.view import View

HEARD_WITHIN = 0.6
"""s in which a robot that is there is heard"""
TRAIL = 400
TRAIL_STEP = 0.05
"""m"""


class Painter:
    """One screen, of what is known from the start and what is seen."""

    def __init__(self, keyboard: Keyboard, known: Dashboard) -> None:
        self._keyboard = keyboard
        self.known = known
        self._looks_until = clock.now() + HEARD_WITHIN
        self._trail: deque[tuple[float, float]] = deque(maxlen=TRAIL)
        self._lines: list[str] = []
        self._shown: object = None

    def __call__(self, view: View) -> None:
        """Show what is seen now."""
        self._follow(view)
        keyboard, terminal = self._keyboard, self._keyboard.terminal
        left = keyboard.idle_left(view.now)
        dashboard = self.known._replace(
            drive=keyboard.drive,
            speeds=keyboard.speeds,
            seen=view,
            idle_left=left if left is None else round(left, 1),
            looking=view.status is None and clock.now() < self._looks_until,
            certainty=keyboard.certainty,
            keys=keyboard.help,
        )
        size = terminal.size()
        shown = (dashboard._replace(seen=View()), *visible(view), len(self._trail), size)
        if shown != self._shown:
            self._shown = shown
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


def visible(view: View) -> tuple[View, object]:
    """Return what of a view can be seen: no times, and no counters."""
    status, odom = view.status, view.odom
    if status is not None:
        status = replace(status, written=0.0, seq=0, refused=0, clamped=0, latency=0.0)
    place = (odom.pose.pose, odom.twist.twist) if odom is not None else None
    return view._replace(now=0.0, status=status, odom=None), place
