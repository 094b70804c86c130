"""`zteleop calibrate --web` in a real browser: whoever watches the wheels has a phone in the hand."""

from collections.abc import Callable, Iterator

import msgspec
import pytest
from desk import CHROMIUM, chromium, opened
from playwright.sync_api import Browser, Page, expect
from processes import Process
from rig import NEUTRAL, Rig, hear, until

from zteleop.control.settings import DONKEYCAR
from zteleop.messages import Odometry
from zteleop.sim.unknown import unknown

pytestmark = pytest.mark.skipif(not CHROMIUM, reason="not here: chromium (Debian: chromium)")
SEED = 3
REALLY = unknown(DONKEYCAR, SEED)
TICK = 4.08
STEERING, THROTTLE = 0, 1
BUTTONS = {STEERING: ("left 1", "right 1"), THROTTLE: ("up 1", "down 1")}
"""that raise, and lower, the ticks of each"""


@pytest.fixture
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("calibrate")) as bench:
        yield bench


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with chromium(tmp_path_factory.mktemp("chromium")) as opened:
        yield opened


def calibrate(rig: Rig) -> Process:
    where = ("--robot", rig.robot, "--no-multicast-scouting", "--listen", rig.endpoint)
    process = rig.run("calibrate", "--web", "--port", "0", *where)
    process.says("open http://127.0.0.1:")
    return process


class Sitting:
    """Somebody who presses buttons until the chip is where he wants it."""

    def __init__(self, rig: Rig, page: Page) -> None:
        self.rig = rig
        self.page = page
        self.neutral = [*NEUTRAL]

    def turn(self, channel: int, ticks: int) -> None:
        up, down = BUTTONS[channel]
        moved = ticks - self.neutral[channel]
        button = self.page.get_by_role("button", name=up if moved > 0 else down, exact=True)
        for _ in range(abs(moved)):
            button.click()
        self.stands(channel, ticks)

    def stands(self, channel: int, ticks: int) -> None:
        until(lambda: self.rig.ticks[channel] == ticks, f"{ticks} at the chip, not {self.rig.ticks}")
        expect(self.page.locator("#ticks")).to_have_text(str(ticks))

    def reverse(self, ticks: int, below: int, looks: Callable[[], object]) -> None:
        """Go below neutral once, to neutral, and then again: this ESC brakes first."""
        self.turn(THROTTLE, below)
        looks()
        self.press("neutral")
        self.stands(THROTTLE, self.neutral[THROTTLE])
        looks()
        self.turn(THROTTLE, ticks)

    def press(self, button: str) -> None:
        self.page.get_by_role("button", name=button, exact=True).click()

    def answers(self, number: int) -> None:
        self.press("that is it")
        expect(self.page.locator("#step")).to_have_text(f"{number + 1} of 7")
        expect(self.page.locator("#state")).to_have_text("idle")


def test_a_car_that_nobody_knew_is_found_out_from_a_phone(rig: Rig, browser: Browser) -> None:
    throttle, steering = REALLY.servos["throttle"], REALLY.servos["steering"]
    sim = rig.join("sim", "--unknown", "--seed", str(SEED))
    server = calibrate(rig)
    odoms = rig.node("watcher").subscription("odom", Odometry)

    def looks() -> None:
        """Wait until the simulator has looked at the chip: it says so often where it is."""
        list(odoms.take())
        for _ in range(3):
            hear(odoms, lambda seen: True, "the simulator")

    def ticks_of(pulse_us: float) -> int:
        return round(pulse_us / TICK)

    begins = REALLY.settings.esc_deadband_us
    forward = int((throttle.neutral_us + begins) / TICK) + 1
    backward = -int((begins - throttle.neutral_us) // TICK) - 1
    with opened(browser, server, "phone", state="waits for you") as page:
        expect(page.locator("#asks")).to_contain_text("Lift")
        page.get_by_role("button", name="wheels up").click()
        expect(page.locator("#asks")).to_contain_text("Turn the throttle until the wheels only just begin")
        sitting = Sitting(rig, page)
        sitting.turn(THROTTLE, forward)
        sitting.answers(1)
        sitting.reverse(backward, backward - 10, looks)
        sim.says("and turn at -0.")
        sitting.press("that is it")
        expect(page.locator("#step")).to_have_text("3 of 7")
        middle = (forward + backward) / 2
        until(lambda: abs((rig.ticks[THROTTLE] or 0) - middle) <= 1, "the motor's own neutral")
        sitting.neutral[THROTTLE] = rig.ticks[THROTTLE] or 0
        sitting.turn(STEERING, ticks_of(steering.neutral_us))
        sitting.answers(3)
        sitting.turn(STEERING, ticks_of(steering.max_us))
        sitting.answers(4)
        sitting.turn(STEERING, ticks_of(steering.min_us))
        sitting.answers(5)
        sitting.turn(THROTTLE, ticks_of(throttle.max_us))
        sitting.answers(6)
        sitting.reverse(ticks_of(throttle.min_us), backward - 10, looks)
        sitting.press("that is it")
        expect(page.locator("#asks")).to_contain_text("config.toml is written")
        expect(page.locator("#state")).to_have_text("done")
    assert server.ends() == 0
    found = msgspec.toml.decode((rig.folder / "config.toml").read_bytes())["drive"]["servos"]
    for name, servo in REALLY.servos.items():
        for field in ("min_us", "neutral_us", "max_us"):
            assert abs(found[name][field] - getattr(servo, field)) <= 2 * TICK, (name, field)
    assert found["throttle"]["reverse"] == REALLY.settings.reverse == "double_tap"


def test_nothing_turns_before_the_wheels_are_up_and_whoever_leaves_writes_nothing(
    rig: Rig, browser: Browser
) -> None:
    before = (rig.folder / "config.toml").read_bytes()
    server = calibrate(rig)
    with opened(browser, server, state="waits for you") as page:
        page.keyboard.press("ArrowUp")
        assert rig.ticks == (None, None), "no actuator runs"
        page.get_by_role("button", name="wheels up").click()
        sitting = Sitting(rig, page)
        sitting.turn(THROTTLE, NEUTRAL[THROTTLE] + 3)
        page.keyboard.press("Space")  # which presses no button that was clicked before
        sitting.stands(THROTTLE, NEUTRAL[THROTTLE])
        sitting.turn(THROTTLE, NEUTRAL[THROTTLE] + 3)
        with opened(browser, server, state="driving") as other:
            other.get_by_role("button", name="STOP").click()
            until(lambda: rig.ticks == NEUTRAL, "neutral")
            expect(page.locator("#state")).to_have_text("stopped")
            page.keyboard.press("ArrowUp")
            expect(page.locator("#note")).to_be_visible()
            other.get_by_role("button", name="release").click()
            expect(page.locator("#state")).to_have_text("idle")
        page.keyboard.press("PageUp")
        sitting.stands(THROTTLE, NEUTRAL[THROTTLE] + 10)
        page.get_by_role("button", name="leave").click()
        expect(page.locator("#asks")).to_contain_text("left before the end")
    assert server.ends() == 1
    assert rig.ticks == NEUTRAL
    assert (rig.folder / "config.toml").read_bytes() == before
