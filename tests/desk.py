"""A screen that nobody sees, a window on it, and fingers on the keys; and a browser."""

import os
import re
import shutil
import subprocess
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, Page, expect, sync_playwright
from processes import Process, descendants
from rig import NEUTRAL, Rig, every, until

QUIET = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
CORNER = ("1020", "760")
"""of the screen, where no window is"""
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
WITHIN = 60_000
"""ms that a browser may take on a machine that has much else to do"""
SIZES = {"phone": (390, 844), "tablet": (820, 1180), "desktop": (1440, 900)}
expect.set_options(timeout=WITHIN)
CLASS = "desk"
"""what a program must call its window"""


@contextmanager
def screen() -> Iterator[str]:
    """Yield the name of a display."""
    reading, writing = os.pipe()
    command = ["Xvfb", "-displayfd", str(writing), "-screen", "0", "1024x768x24", "-nolisten", "tcp"]
    server = subprocess.Popen([*command, "+extension", "GLX"], pass_fds=[writing], **QUIET)
    os.close(writing)
    try:
        with os.fdopen(reading) as number:
            yield f":{number.readline().strip()}"
    finally:
        server.terminate()
        server.wait()


class Desk:
    """A program's window in which somebody drives, and fingers on the keys."""

    def __init__(self, rig: Rig, display: str, command: list[str], about: Mapping[str, str]) -> None:
        self._rig = rig
        surroundings = {"DISPLAY": display, "LIBGL_ALWAYS_SOFTWARE": "1", "LC_ALL": "C.UTF-8"}
        self._environment = {**rig.environment, **surroundings, **about}
        self.program = subprocess.Popen(command, env=self._environment, cwd=rig.folder, **QUIET)

    def focus(self) -> None:
        """Wait for the window; one that is not on the screen yet, or is gone again, cannot have the focus."""
        words = ("search", "--sync", "--onlyvisible", "--class", CLASS, "windowfocus", "--sync")
        until(lambda: self._try(*words), "a window with the focus")

    def _do(self, *words: str) -> None:
        assert self._try(*words), words

    def _try(self, *words: str) -> bool:
        return not subprocess.run(["xdotool", *words], env=self._environment, timeout=60, **QUIET).returncode

    def hold(self, *keys: str) -> None:
        self._do("keydown", *keys)

    def let_go(self, *keys: str) -> None:
        self._do("keyup", *keys)

    def drives_at_last(self, key: str) -> None:
        """Hold a key until the keyboard is there and the wheels turn; what came too early is let go first."""

        def turns() -> bool:
            self.let_go(key)
            self.hold(key)
            return any(self._rig.ticks[1] != NEUTRAL[1] for _ in every(0.05, 20))

        until(turns, "a keyboard that drives")

    def look_elsewhere(self) -> None:
        """Take the focus away from the window, and the pointer, which would bring it keys as well."""
        self._do("mousemove", *CORNER, "search", "--maxdepth", "0", ".*", "windowfocus")

    def close(self) -> None:
        left = descendants(self.program.pid)
        self.program.terminate()
        self.program.wait()
        until(
            lambda: not any(Path(f"/proc/{pid}").exists() for pid in left),
            "the end of what ran in the window",
        )


@contextmanager
def sits(rig: Rig, display: str, command: list[str], about: Mapping[str, str]) -> Iterator[Desk]:
    """Sit down before a program until all is let go and the robot rests."""
    desk = Desk(rig, display, command, about)
    try:
        desk.focus()
        yield desk
    finally:
        for key in ("Up", "Left", "Right"):
            desk.let_go(key)
        desk.close()
        until(lambda: rig.ticks == NEUTRAL, "rest")


def loses_the_focus(rig: Rig, here: Desk) -> None:
    """Hold a key while the focus goes and comes back: it drives no longer, and arms nothing."""
    here.drives_at_last("Up")
    here.look_elsewhere()
    until(lambda: rig.ticks == NEUTRAL, "rest")
    here.focus()
    for _ in every(0.1, 10):
        assert rig.ticks == NEUTRAL, "the key is still down, and arms nothing"
    here.let_go("Up")
    here.drives_at_last("Up")


@contextmanager
def chromium(folder: Path) -> Iterator[Browser]:
    """Yield a browser that leaves what it leaves in a folder."""
    own = {**os.environ, "TMPDIR": str(folder)}
    with sync_playwright() as player:
        browser = player.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox"], env=dict(own), timeout=WITHIN
        )
        yield browser
        browser.close()


@contextmanager
def opened(
    browser: Browser,
    server: Process,
    size: str = "desktop",
    script: str = "",
    state: str = "idle",
    **about: Any,
) -> Iterator[Page]:
    """Open the address that the server has printed; nothing may be wrong in the page until it is closed."""
    found = re.search(r"http://\S+", server.text)
    assert found
    wide, high = SIZES[size]
    context = browser.new_context(viewport={"width": wide, "height": high}, **about)
    context.add_init_script(script)
    context.set_default_timeout(WITHIN)
    page, wrong = context.new_page(), list[str]()
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.on("console", lambda said: wrong.append(said.text) if said.type == "error" else None)
    page.goto(found[0])
    expect(page.locator("#state")).to_have_text(state)
    yield page
    context.close()
    assert wrong == []
