"""Draw the keyboard's screen as PNG: what a terminal shows of a demo that is being driven.

pip install -e .[docs]
python docs/screens.py                  # 100 columns, dark and light, into docs/
python docs/screens.py /tmp --all       # 20, 60, 100 and 200 columns, driving and stopped
"""

import argparse
import fcntl
import os
import pty
import select
import struct
import subprocess
import sys
import termios
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pyte
from PIL import Image, ImageDraw, ImageFont

SIZES = {20: 12, 60: 20, 100: 30, 200: 50}
"""rows of each width"""
CELL = (10, 20)
THEMES = {
    "dark": {
        **{"paper": "#14181f", "default": "#d7dce4", "dim": "#77808d", "white": "#ffffff", "red": "#e06c75"},
        **{"green": "#4ec98a", "brown": "#e0b050", "cyan": "#56c2d6"},
    },
    "light": {
        **{"paper": "#ffffff", "default": "#24292f", "dim": "#818b98", "white": "#ffffff", "red": "#c0273a"},
        **{"green": "#14803c", "brown": "#9a6700", "cyan": "#0b7285"},
    },
}
UP, LEFT, BACKSPACE = "\x1b[A", "\x1b[D", "\x7f"
BRAILLE = ((0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (1, 3))
"""The place in its cell of each bit of a braille character."""
PATIENCE = 20.0


class Screen(pyte.Screen):
    """A terminal that knows faint text as well."""

    def select_graphic_rendition(self, *attributes: int, **kwargs: bool) -> None:
        super().select_graphic_rendition(*attributes, **kwargs)
        if 2 in attributes:
            self.cursor.attrs = self.cursor.attrs._replace(fg="dim")


class Demo:
    """A demo in a terminal of some size."""

    def __init__(self, columns: int, rows: int, *options: str) -> None:
        self.screen = Screen(columns, rows)
        self._stream = pyte.ByteStream(self.screen)
        self._master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        self.process = subprocess.Popen(
            [sys.executable, "-m", "zteleop", "demo", *options],
            stdin=slave,
            stdout=slave,
            stderr=slave,
            env={**os.environ, "TERM": "xterm-256color", "LC_ALL": "C.UTF-8"},
        )
        os.close(slave)

    def wait(self, done: Callable[[], bool]) -> None:
        """Take in what is shown until something is so."""
        end = time.monotonic() + PATIENCE
        while not done():
            if time.monotonic() > end:
                sys.exit("the demo never showed what was waited for:\n" + "\n".join(self.screen.display))
            if select.select([self._master], [], [], 0.1)[0]:
                self._stream.feed(os.read(self._master, 65536))

    def shows(self, text: str) -> None:
        self.wait(lambda: any(text in line for line in self.screen.display))

    def run(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        self.wait(lambda: time.monotonic() > end)

    def type(self, *keys: str) -> None:
        for key in keys:
            os.write(self._master, key.encode())
            self.run(0.1)

    def close(self) -> None:
        os.write(self._master, b"q")
        self.process.wait(PATIENCE)
        os.close(self._master)


def draw(screen: pyte.Screen, theme: dict[str, str], fonts: list[ImageFont.FreeTypeFont]) -> Image.Image:
    """Return what a terminal shows, dots of braille as dots."""
    width, height = CELL
    image = Image.new("RGB", ((screen.columns + 2) * width, (screen.lines + 1) * height), theme["paper"])
    canvas = ImageDraw.Draw(image)
    for row in range(screen.lines):
        for column in range(screen.columns):
            cell = screen.buffer[row][column]
            left, top = (column + 1) * width, row * height + height // 2
            if cell.bg != "default":
                canvas.rectangle((left, top, left + width - 1, top + height - 1), theme[cell.bg])
            ink = theme["white" if cell.fg == "brightwhite" else cell.fg]
            if 0x2800 <= ord(cell.data) < 0x2900:
                for x, y in dots(ord(cell.data) - 0x2800):
                    at = left + 5 * x + 1, top + 5 * y + 1
                    canvas.ellipse((*at, at[0] + 3, at[1] + 3), ink)
            else:
                canvas.text((left, top), cell.data, ink, fonts[cell.bold])
    return image


def dots(bits: int) -> Iterator[tuple[int, int]]:
    return (place for bit, place in enumerate(BRAILLE) if bits >> bit & 1)


def main() -> None:
    parser = argparse.ArgumentParser(description="Draw the keyboard's screen as PNG.")
    parser.add_argument("folder", nargs="?", type=Path, default=Path(__file__).parent)
    parser.add_argument("--all", action="store_true", help="every size, driving and stopped")
    options = parser.parse_args()
    fonts = [ImageFont.truetype(f"DejaVuSansMono{weight}.ttf", 16) for weight in ("", "-Bold")]
    for columns in SIZES if options.all else (100,):
        demo = Demo(columns, SIZES[columns])
        demo.shows("idle")
        demo.type(*[UP] * 14, *[LEFT] * 4)
        demo.run(4.5)
        demo.type(UP, LEFT)
        for name in ("driving", "stopped") if options.all else ("keyboard",):
            if name == "stopped":
                demo.type(BACKSPACE)
                demo.shows("stopped")
                demo.run(0.5)
            for theme, colours in THEMES.items():
                size = f"-{columns}" if options.all else ""
                draw(demo.screen, colours, fonts).save(
                    options.folder / f"{name}{size}-{theme}.png", optimize=True
                )
        demo.close()


if __name__ == "__main__":
    main()
