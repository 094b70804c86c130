"""The picture of a simulated camera, as the JPEG that a real one would say."""

from io import BytesIO

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.topics import TOPICS
from zteleop.errors import ConfigError, install
from zteleop.messages import CompressedImage, Header
from zteleop.sim.camera import SKY, Camera
from zteleop.sim.world import World

TOPIC = "camera/image/compressed"
QUALITY = 80
"""of a JPEG: 100 would be three times as long"""


class Painter:
    """Draws what a camera sees; raises ConfigError where what draws is not installed."""

    def __init__(self, camera: Camera) -> None:
        try:
            from PIL import Image, ImageDraw
        except ModuleNotFoundError:
            raise ConfigError(
                f"a camera's picture needs Pillow, which is not installed; say: {install('camera')}"
            ) from None
        self._camera = camera
        self._new = Image.new
        self._on = ImageDraw.Draw

    def jpeg(self, world: World) -> bytes:
        """Return the picture from where the robot is."""
        lens = self._camera.lens
        image = self._new("RGB", (lens.width, lens.height), SKY)
        drawing = self._on(image)
        drawing.rectangle((0, lens.horizon, lens.width, lens.height), fill=self._camera.floor)
        for polygon in self._camera.look(world.pose):
            drawing.polygon(polygon.points, fill=polygon.colour)
        file = BytesIO()
        image.save(file, "JPEG", quality=QUALITY)
        return file.getvalue()


def take_pictures(node: Node, camera: Camera, world: World) -> None:
    """Say what a camera sees, 20 times a second."""
    painter = Painter(camera)
    pictures = node.publisher(TOPIC, CompressedImage)

    @node.every(TOPICS[TOPIC].every)
    def take() -> None:
        pictures.publish(CompressedImage(Header(clock.stamp(), "camera"), "jpeg", painter.jpeg(world)))
