"""Makes the pictures of docs/web.md: python docs/pages.py ADDRESS, of a `zteleop web`; needs Chromium."""

import shutil
import sys
from collections.abc import Callable, Sequence
from io import BytesIO
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

FOLDER = Path(__file__).parent
DESKTOP, TABLET, HALF, PHONE = (1440, 900), (820, 1180), (1180, 820), (390, 844)
GAP = 16
DRIVES = 1500
"""ms before each picture"""
RATES = 3000
"""ms in which rates are counted"""
LINES = ("twist.twist.linear.x", "twist.twist.angular.z")


def main() -> None:
    with sync_playwright() as player:
        browser = player.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        three = ((DESKTOP, "dark"), (TABLET, "dark"), (PHONE, "light"))
        beside("web.png", [shoot(browser, size, colours) for size, colours in three])
        beside("web-bus.png", [shoot(browser, HALF, "light", lines), shoot(browser, HALF, "dark", graph)])
        browser.close()


def beside(name: str, shots: Sequence[Image.Image]) -> None:
    """Write pictures side by side."""
    high = max(shot.height for shot in shots)
    picture = Image.new("RGBA", (sum(shot.width + GAP for shot in shots) - GAP, high))
    left = 0
    for shot in shots:
        picture.paste(shot, (left, (high - shot.height) // 2))
        left += shot.width + GAP
    picture.quantize(128).save(FOLDER / name, optimize=True)


def lines(page: Page) -> None:
    page.locator("#tab-topics").click()
    page.locator("#topics-list button", has_text="odom").click()
    for line in LINES:
        page.get_by_label(line, exact=True).check()


def graph(page: Page) -> None:
    page.locator("#tab-graph").click()


def shoot(
    browser: Browser, size: tuple[int, int], colours: str, enter: Callable[[Page], None] | None = None
) -> Image.Image:
    """Return a picture of the page while it drives to the left, in the room that it enters."""
    viewport = {"width": size[0], "height": size[1]}
    page = browser.new_page(viewport=viewport, color_scheme=colours)  # type: ignore[arg-type]
    page.goto(sys.argv[1])
    page.get_by_text("nobody drives").wait_for()
    if enter:
        enter(page)
    for key in ("ArrowUp", "ArrowLeft"):
        page.keyboard.down(key)
    page.wait_for_timeout(RATES if enter else DRIVES)
    shot = Image.open(BytesIO(page.screenshot())).convert("RGBA")
    page.close()
    return shot


if __name__ == "__main__":
    main()
