"""Follow the yellow line that the camera sees, until Ctrl-C.

Needs Pillow (pip install 'zteleop[camera]') and a robot with a camera: zteleop sim --scene track --camera
"""

from io import BytesIO

from PIL import Image

from zteleop import CompressedImage, Node, Twist

SPEED = 0.6  # m/s
STEER = 2.5  # rad/s for a line at the edge of the picture
ROWS = (0.55, 0.8)  # of the picture from its top: the floor just ahead
YELLOW = range(25, 50)  # of 256 hues
STRONG = 90  # of 256: less is grey


def place_of_line(jpeg: bytes) -> float | None:
    """Return where the line is, from 1 (left edge) to -1 (right edge); None where there is none."""
    picture = Image.open(BytesIO(jpeg)).convert("HSV")
    width, height = picture.size
    floor = picture.crop((0, int(ROWS[0] * height), width, int(ROWS[1] * height)))
    hue, strength, _ = floor.split()
    yellow = hue.point(lambda value: 255 if value in YELLOW else 0)
    strong = strength.point(lambda value: 255 if value > STRONG else 0)
    both = Image.composite(yellow, Image.new("L", floor.size), strong)
    columns = both.resize((width, 1), Image.Resampling.BOX).tobytes()
    if (mass := sum(columns)) < width:
        return None
    middle = sum(at * column for at, column in enumerate(columns)) / mass
    return 1 - 2 * middle / width


def main() -> None:
    """Drive."""
    with Node("line_follower", robot="archangel") as node:
        motors = node.publisher("cmd_vel", Twist)
        seen = True

        @node.on("camera/image/compressed", CompressedImage)
        def look(image: CompressedImage) -> None:
            nonlocal seen
            place = place_of_line(image.data)
            if seen != (place is not None):
                seen = place is not None
                print("the line is there again" if seen else "no line: it stands", flush=True)
            motors.publish(
                Twist.planar(SPEED, STEER * place) if place is not None else Twist.planar(0.0, 0.0)
            )

        node.spin()


if __name__ == "__main__":
    main()
