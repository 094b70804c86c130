"""What a simulated camera sees where three scenes start, in one picture: python docs/camera.py draws it."""

from io import BytesIO
from pathlib import Path

from PIL import Image

from zteleop.cli import _scenes
from zteleop.nodes.picture import Painter
from zteleop.sim.body import Disc
from zteleop.sim.camera import Camera, Lens
from zteleop.sim.world import World

SCENES = ("track", "classroom", "maze")
POINT = (Disc(0.0, 0.05),)
"""a robot that is nearly none"""


def main() -> None:
    lens = Lens()
    whole = Image.new("RGB", (lens.width * len(SCENES), lens.height))
    for at, name in enumerate(SCENES):
        scene = _scenes.find(name)
        jpeg = Painter(Camera(scene)).jpeg(World(scene, POINT))
        whole.paste(Image.open(BytesIO(jpeg)), (at * lens.width, 0))
    whole.quantize(64).save(Path(__file__).with_name("camera.png"), optimize=True)


if __name__ == "__main__":
    main()
