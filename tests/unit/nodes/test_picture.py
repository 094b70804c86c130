"""The simulated camera's picture as JPEG, and the example that follows a line by it."""

import builtins
import sys
from io import BytesIO
from math import hypot
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from zteleop.cli import _scenes
from zteleop.control.mixer import Ackermann
from zteleop.control.motion.pose import Pose2D
from zteleop.control.settings import DONKEYCAR
from zteleop.errors import ConfigError
from zteleop.messages import Twist
from zteleop.nodes.picture import Painter
from zteleop.sim import outline
from zteleop.sim.camera import PAINTS, Camera
from zteleop.sim.car import Car
from zteleop.sim.scene import Scene, Tape
from zteleop.sim.world import World

sys.path.append(str(Path(__file__).parents[3] / "examples"))

import line_follower

DISCS = Car(Ackermann(), DONKEYCAR).discs
HORIZON, FLOOR = 40, 200
"""rows of the picture"""


def picture(scene: Scene, heading: float = 0.0) -> Image.Image:
    world = World(scene, DISCS)
    world.pose = Pose2D(0.0, 0.0, heading)
    return Image.open(BytesIO(Painter(Camera(scene)).jpeg(world)))


def near(pixel: Any, colour: tuple[int, int, int]) -> bool:
    return all(abs(a - b) < 25 for a, b in zip(pixel, colour, strict=True))


def test_it_is_a_jpeg_of_floor_and_sky() -> None:
    image = picture(Scene(floor="green"))
    assert (image.format, image.size) == ("JPEG", (320, 240))
    assert near(image.getpixel((160, FLOOR)), PAINTS["green"])
    assert not near(image.getpixel((160, HORIZON)), PAINTS["green"])


def test_a_line_is_where_it_lies() -> None:
    image = picture(Scene(tapes=[Tape(points=[(0.0, 0.0), (3.0, 0.0)], width=0.1, colour="yellow")]))
    assert near(image.getpixel((160, FLOOR)), PAINTS["yellow"])
    assert near(image.getpixel((40, FLOOR)), PAINTS["grey"])


def test_without_pillow_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def no_pillow(name: str, *rest: Any) -> Any:
        if name.startswith("PIL"):
            raise ModuleNotFoundError(name="PIL")
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", no_pillow)
    with pytest.raises(ConfigError, match=r"pip install .*\[camera\]'"):
        Painter(Camera(Scene()))


@pytest.mark.parametrize(("left", "side"), [(0.2, 1), (-0.2, -1), (0.0, 0)])
def test_the_follower_sees_on_which_side_the_line_is(left: float, side: int) -> None:
    scene = Scene(tapes=[Tape(points=[(0.0, left), (3.0, left)], colour="yellow")])
    place = line_follower.place_of_line(Painter(Camera(scene)).jpeg(World(scene, DISCS)))
    assert place is not None
    assert place == pytest.approx(0, abs=0.05) if side == 0 else place * side > 0.1


def test_the_follower_sees_no_line_where_there_is_none() -> None:
    scene = Scene(tapes=[Tape(points=[(0.0, 0.0), (3.0, 0.0)], colour="white")])
    assert line_follower.place_of_line(Painter(Camera(scene)).jpeg(World(scene, DISCS))) is None


def test_the_follower_goes_round_the_track_and_never_leaves_the_line() -> None:
    """In simulated time: 20 pictures a second, each answered at once."""
    scene = _scenes.find("track")
    car, camera = Car(Ackermann(), DONKEYCAR), Camera(scene)
    world = car.room = World(scene, car.discs)
    painter, line = Painter(camera), scene.tapes[0]
    servos, mixer = DONKEYCAR, Ackermann()
    for _ in range(50 * 20):
        place = line_follower.place_of_line(painter.jpeg(world))
        assert place is not None, f"the line is lost at {world.pose}"
        wheels = mixer.mix(Twist.planar(line_follower.SPEED, line_follower.STEER * place))
        car.step({servo.channel: servo.pulse_us(wheels[name]) for name, servo in servos.items()}, 0.05)
        assert min(away(world.pose, *side) for side in outline.sides(line.points, line.closed)) < 0.25
    assert car.distance > 22, "once round"


def away(pose: Pose2D, a: tuple[float, float], b: tuple[float, float]) -> float:
    """Return how far a pose is from a straight part of the line, m."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    share = ((pose.x - a[0]) * dx + (pose.y - a[1]) * dy) / (dx * dx + dy * dy)
    share = max(0.0, min(1.0, share))
    return hypot(pose.x - a[0] - share * dx, pose.y - a[1] - share * dy)
