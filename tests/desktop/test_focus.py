"""A page in a browser's own window, which loses the focus as windows do: no other way is as real."""

import re
import shutil
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from desk import CLASS, Desk, loses_the_focus, screen, sits
from processes import descendants
from rig import NEUTRAL, Rig, until

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
MISSING = [name for name in ("Xvfb", "xdotool") if not shutil.which(name)] + ["chromium"] * (not CHROMIUM)
pytestmark = pytest.mark.skipif(
    bool(MISSING), reason=f"not here: {', '.join(MISSING)} (Debian: xvfb xdotool chromium)"
)
PLACE = ["--window-size=640,560", "--window-position=0,0"]
PLAIN = ["--no-sandbox", "--no-first-run", "--disable-gpu", *PLACE, f"--class={CLASS}"]


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("focus")) as bench:
        bench.actuator()
        yield bench


@contextmanager
def page(rig: Rig) -> Iterator[Desk]:
    """Open the page in a window of its own, as an app."""
    server = rig.join("web", "--port", "0")
    server.says("open http://127.0.0.1:")
    found = re.search(r"http://\S+", server.text)
    assert found
    assert CHROMIUM
    command = [CHROMIUM, *PLAIN, f"--user-data-dir={rig.folder / 'profile'}", f"--app={found[0]}"]
    home = str(rig.folder)
    with screen() as display, sits(rig, display, command, {"HOME": home, "TMPDIR": home}) as desk:
        yield desk
    server.signal(signal.SIGINT)
    server.ends()


def test_a_key_that_is_held_while_the_focus_goes_drives_no_longer_and_arms_nothing(rig: Rig) -> None:
    with page(rig) as here:
        loses_the_focus(rig, here)


def test_a_browser_that_is_killed_is_neutral(rig: Rig) -> None:
    with page(rig) as here:
        here.drives_at_last("Up")
        parts = descendants(here.program.pid)
        here.program.kill()
        until(lambda: rig.ticks == NEUTRAL, "rest")
        until(lambda: not any(Path(f"/proc/{part}").exists() for part in parts), "the end of its parts")
