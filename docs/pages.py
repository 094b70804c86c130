"""Makes docs/web.png: python docs/pages.py ADDRESS, as `zteleop web` has printed it; needs Chromium."""

import shutil
import sys
from io import BytesIO
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, sync_playwright

PICTURE = Path(__file__).parent / "web.png"
DESKTOP, PHONE = (1280, 760), (390, 844)
GAP = 16
DRIVES = 1500
"""ms before each picture"""


def main() -> None:
    with sync_playwright() as player:
        browser = player.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        shots = [shoot(browser, DESKTOP, "dark"), shoot(browser, PHONE, "light")]
        browser.close()
    high = max(shot.height for shot in shots)
    picture = Image.new("RGBA", (sum(shot.width for shot in shots) + GAP, high))
    left = 0
    for shot in shots:
        picture.paste(shot, (left, (high - shot.height) // 2))
        left += shot.width + GAP
    picture.quantize(128).save(PICTURE, optimize=True)


def shoot(browser: Browser, size: tuple[int, int], colours: str) -> Image.Image:
    """Return a picture of the page while it drives to the left."""
    viewport = {"width": size[0], "height": size[1]}
    page = browser.new_page(viewport=viewport, color_scheme=colours)  # type: ignore[arg-type]
    page.goto(sys.argv[1])
    page.get_by_text("nobody drives").wait_for()
    for key in ("ArrowUp", "ArrowLeft"):
        page.keyboard.down(key)
    page.wait_for_timeout(DRIVES)
    shot = Image.open(BytesIO(page.screenshot())).convert("RGBA")
    page.close()
    return shot


if __name__ == "__main__":
    main()
