"""The page: from a key in a browser to the registers of the chip, with video; and what twenty viewers cost.

A browser shares the cores with everything else here. A key's time begins when the browser made its event.
The picture is 640x480, 20 a second, of `zteleop camera test`. Needs Chromium, ffmpeg and playwright.
"""

import asyncio
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from figures import is_quick, median, p99, paced, print_table, verdict
from idle_cost import cpu_seconds, private_mb
from playwright.sync_api import Page, sync_playwright
from processes import running
from robot import LONGEST, LOOK_EVERY, Robot
from websockets.asyncio.client import connect

TARGET, START, CORE, MEMORY = 10.0, 300.0, 60.0, 40.0
"""ms from key to register in the middle, ms until it serves, % of a core with 20 viewers, private MB"""
TRANSFERRED, INTERACTIVE, FRAMES = 150.0, 500.0, 60.0
"""kB, ms, and pictures a second that a page draws"""
VIEWERS = 20
WATCH = "--watch"
TOPICS = ["drive_status", "odom", "camera/image/compressed", "battery_state"]
KEYS = """addEventListener("keydown", event => {
    window.pressed = performance.timeOrigin + event.timeStamp;
}, true)"""
DRAWN = """() => new Promise(done => {
    let [frames, began] = [0, performance.now()];
    const next = () => {
        frames += 1;
        const seconds = (performance.now() - began) / 1000;
        seconds < 3 ? requestAnimationFrame(next) : done(frames / seconds);
    };
    requestAnimationFrame(next);
})"""
LOADED = """() => {
    const [page] = performance.getEntriesByType("navigation");
    const all = [page, ...performance.getEntriesByType("resource")];
    return [all.reduce((sum, one) => sum + one.transferSize, 0) / 1000, page.domInteractive];
}"""


def main() -> None:
    presses, seconds = (20, 3.0) if is_quick(__doc__) else (200, 20.0)
    with Robot() as robot, tempfile.TemporaryDirectory(prefix="zteleop-page-") as folder:
        server, address, start = serve(robot)  # before what starts beside it
        robot.start("sim", "--connect", robot.endpoint, "--scene", "classroom")
        robot.start("camera", "test", "--connect", robot.endpoint)
        with sync_playwright() as player:
            browser = player.chromium.launch(
                executable_path=shutil.which("chromium"),
                args=["--no-sandbox"],
                env={**os.environ, "TMPDIR": folder},
            )
            page = browser.new_page()
            page.add_init_script(KEYS)
            page.goto(address)
            page.locator("#eye").wait_for(state="visible")
            transferred, interactive = page.evaluate(LOADED)
            drawn = page.evaluate(DRAWN)
            alone = list(press(robot, page, presses))
            before = share(server, seconds)
            with viewers(address):
                time.sleep(2.0)
                beside = share(server, seconds)
                crowded = list(press(robot, page, presses))
                memory = private_mb(server)
            browser.close()
    python = paced(START, _python())
    print_table(
        f"key in a browser to the registers, ms, {len(alone)} presses, with video",
        ["who looks", "p50", "p99", "target for p50"],
        [
            ["the operator", median(alone), p99(alone), verdict(median(alone), TARGET, "ms")],
            [
                f"and {VIEWERS} viewers",
                median(crowded),
                p99(crowded),
                verdict(median(crowded), 2 * median(alone), "ms"),
            ],
        ],
    )
    print_table(
        "the server, and what it serves",
        ["what", "found", "target"],
        [
            ["start until it serves, ms", start, verdict(start, python, "ms")],
            ["% of a core, one page", before, ""],
            [f"% of a core, {VIEWERS} viewers more", beside, verdict(beside, CORE, "%")],
            ["private memory, MB", memory, verdict(memory, MEMORY, "MB")],
            ["transferred, kB", transferred, verdict(transferred, TRANSFERRED, "kB")],
            ["interactive after ms", interactive, verdict(interactive, INTERACTIVE, "ms")],
            ["pictures a second", drawn, f">= {FRAMES:g}: {'met' if drawn >= 0.98 * FRAMES else 'MISSED'}"],
        ],
    )


def serve(robot: Robot) -> tuple["subprocess.Popen[str]", str, float]:
    """Start a server; return it with its address and the ms until it printed that."""
    began = time.perf_counter()
    server = robot.start("web", "--connect", robot.endpoint, "--port", "0", stdout=subprocess.PIPE)
    assert server.stdout
    found = re.search(r"http://\S+", server.stdout.readline())
    if not found:
        raise SystemExit("zteleop web printed no address")
    return server, found[0], 1000 * (time.perf_counter() - began)


def share(server: "subprocess.Popen[str]", seconds: float) -> float:
    """Return the part of a core, in percent, that a process takes for some seconds."""
    before = cpu_seconds(server)
    time.sleep(seconds)
    return 100 * (cpu_seconds(server) - before) / seconds


def press(robot: Robot, page: Page, presses: int) -> Iterator[float]:
    """Press and let go; yield the ms from each key's event to the register."""
    for index in range(presses):
        key, before, found = ("ArrowLeft", "ArrowRight")[index % 2], robot.outputs(), list[float]()
        watcher = threading.Thread(target=_await_change, args=(robot, before, found))
        watcher.start()
        page.keyboard.down(key)
        watcher.join()
        if found:
            yield 1000 * found[0] - page.evaluate("window.pressed")
        page.keyboard.up(key)
        time.sleep(0.15)


def _await_change(robot: Robot, before: bytes, found: list[float]) -> None:
    give_up = time.monotonic() + LONGEST
    while time.monotonic() < give_up:
        if robot.outputs() != before:
            found.append(time.time())
            return
        time.sleep(LOOK_EVERY)


@contextmanager
def viewers(address: str) -> Iterator[None]:
    """Let a process of its own look as twenty pages do."""
    with running([sys.executable, __file__, WATCH, address]):
        yield


async def watch(address: str) -> None:
    """Look until the end, as pages do that drive nothing."""
    place, _, token = address.removeprefix("http://").partition("/#t=")

    async def look() -> None:
        protocols = ["zteleop.v1", f"token.{token}"]
        origin = f"http://{place}"
        async with connect(f"ws://{place}/bus", subprotocols=protocols, origin=origin) as page:  # type: ignore[arg-type]
            await page.send(json.dumps({"is": "watch", "topics": TOPICS}))
            async for _ in page:
                pass

    await asyncio.gather(*(look() for _ in range(VIEWERS)))


def _python() -> float:
    began = time.perf_counter()
    subprocess.run([sys.executable, "-c", "pass"], check=True)
    return 1000 * (time.perf_counter() - began)


if __name__ == "__main__":
    if WATCH in sys.argv:
        asyncio.run(watch(sys.argv[2]))
    else:
        main()
