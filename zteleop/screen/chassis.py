"""The robot itself, drawn on a canvas: its body, and four wheels of which the front ones steer, or two."""

from math import cos, sin

from zteleop.messages import Vehicle
from zteleop.screen.canvas import Canvas, Dot, slope

CAR = ((-0.5, 0.14), (0.25, 0.14), (0.5, 0.04))
TANK = ((-0.4, 0.2), (0.25, 0.2), (0.5, 0.02))
"""Half of the body, which is as wide on the other side: (ahead, aside) from tail to nose, of the length."""
AXLES = (-0.33, 0.3)
TRACK = 0.33
WHEEL = (0.16, 0.055)
"""Half the length and half the breadth."""
ROOM = (0.6, 0.48)
"""Half of what is kept clear around the robot."""
ALONE = 0.35
"""m long where nothing tells"""


def length_of(vehicle: Vehicle | None) -> float:
    """Return how long a robot is, in m, by its wheelbase."""
    wheelbase = vehicle.wheelbase if vehicle else 0.0
    return wheelbase / (AXLES[1] - AXLES[0]) if 0.0 < wheelbase < 100.0 else ALONE


def draw_chassis(
    canvas: Canvas, here: Dot, heading: float, steering: float, vehicle: Vehicle | None, length: float
) -> None:
    """Draw it so many dots long; angles in rad, positive to the left of straight up."""
    tank = vehicle is not None and not vehicle.steers
    middle = (round(here[0]), round(here[1]))

    def place(ahead: float, left: float) -> Dot:
        return (
            middle[0] - length * (ahead * sin(heading) + left * cos(heading)),
            middle[1] - length * (ahead * cos(heading) - left * sin(heading)),
        )

    def box(at: Dot, half: Dot, angle: float, mark: str, style: str = "") -> None:
        c, s = cos(angle), sin(angle)
        turned = [(u * c - v * s, u * s + v * c) for u, v in corners(half)]
        canvas.polygon([place(at[0] + u, at[1] + v) for u, v in turned], mark, style)

    def wheel(axle: float, left: float, angle: float) -> None:
        half = (WHEEL[0], max(WHEEL[1], 0.8 / length))
        style = "cyan" if abs(angle) > 0.01 else ""
        box((axle, left), half, angle, slope(-sin(heading + angle), -cos(heading + angle)), style)

    box((0.0, 0.0), ROOM, 0.0, " ")
    outline = TANK if tank else CAR
    for axle in () if tank else AXLES:
        canvas.line(place(axle, TRACK), place(axle, -TRACK))
    canvas.polygon([place(*p) for p in [*outline, *((u, -v) for u, v in reversed(outline))]], "#")
    canvas.polygon([place(*p) for p in [*outline[-2:], *((u, -v) for u, v in reversed(outline[-2:]))]], "o")
    for axle in (0.0,) if tank else AXLES:
        for left in (TRACK, -TRACK):
            wheel(axle, left, steering if axle > 0 else 0.0)


def corners(half: Dot) -> tuple[Dot, Dot, Dot, Dot]:
    """Return the corners of a box, in order."""
    u, v = half
    return (u, v), (u, -v), (-u, -v), (-u, v)
