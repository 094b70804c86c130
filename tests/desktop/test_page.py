"""The cockpit's page in a real browser: what is held there moves a real robot, and what is let go ends it."""

import re
import signal
from collections.abc import Iterator

import pytest
from desk import CHROMIUM, SIZES, chromium, opened
from playwright.sync_api import Browser, expect
from processes import Process
from rig import NEUTRAL, Rig, until

from zteleop.messages import HazardDetection, HazardDetectionVector, Header, InterfaceButtons, Time

pytestmark = pytest.mark.skipif(not CHROMIUM, reason="not here: chromium (Debian: chromium)")
STEERING, THROTTLE = 0, 1
WATCH = """() => {
    window.said = "";
    const send = WebSocket.prototype.send;
    WebSocket.prototype.send = function (text) {
        const word = JSON.parse(text);
        if (word.is === "held" && !window.said.endsWith(String(word.deadman)))
            window.said += (window.said && ",") + word.deadman;
        return send.call(this, text);
    };
}"""
"""keeps what the page says of its dead-man, whenever that changes"""
KEYS = """kinds => {
    const about = { code: "ArrowUp", bubbles: true };
    for (const kind of kinds) document.body.dispatchEvent(new KeyboardEvent(kind, about));
}"""
SLIDE = "(slider, value) => { slider.value = value; slider.dispatchEvent(new Event('change')); }"


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("page")) as bench:
        bench.actuator()
        bench.join("sim")
        yield bench


@pytest.fixture(scope="module")
def server(rig: Rig) -> Process:
    process = rig.join("web", "--port", "0")
    process.says("open http://127.0.0.1:")
    return process


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with chromium(tmp_path_factory.mktemp("chromium")) as opened:
        yield opened


def drives(rig: Rig) -> None:
    until(lambda: (rig.ticks[THROTTLE] or 0) > NEUTRAL[THROTTLE], "it drives")


def rests(rig: Rig) -> None:
    until(lambda: rig.ticks == tuple(NEUTRAL), "it rests")


def test_keys_drive_while_they_are_held_several_at_once(rig: Rig, browser: Browser, server: Process) -> None:
    with opened(browser, server) as page:
        page.keyboard.down("KeyW")
        drives(rig)
        expect(page.locator("#state")).to_have_text("driving, you operate")
        page.keyboard.down("ArrowLeft")
        until(lambda: (rig.ticks[STEERING] or 0) > NEUTRAL[STEERING], "it steers as well")
        page.keyboard.up("ArrowLeft")
        until(lambda: rig.ticks[STEERING] == NEUTRAL[STEERING], "straight ahead")
        drives(rig)
        page.keyboard.up("KeyW")
        rests(rig)
        expect(page.locator("#state")).to_have_text("idle")
        expect(page.locator("#why")).to_have_text("nobody drives")


@pytest.mark.parametrize("lost", ["blur", "pagehide"])
def test_a_page_that_loses_keys_holds_none(rig: Rig, browser: Browser, server: Process, lost: str) -> None:
    with opened(browser, server) as page:
        page.keyboard.down("ArrowUp")
        drives(rig)
        page.evaluate("name => window.dispatchEvent(new Event(name))", lost)
        rests(rig)


def test_a_page_that_is_closed_or_loaded_anew_lets_go(rig: Rig, browser: Browser, server: Process) -> None:
    with opened(browser, server) as page:
        page.keyboard.down("ArrowUp")
        drives(rig)
        page.reload()
        rests(rig)
        expect(page.locator("#state")).to_have_text("idle")
        page.keyboard.up("ArrowUp")
        page.keyboard.down("ArrowUp")
        drives(rig)
    rests(rig)


@pytest.mark.parametrize("size", SIZES)
def test_a_finger_on_the_stick_drives_while_it_is_there(
    rig: Rig, browser: Browser, server: Process, size: str
) -> None:
    with opened(browser, server, size) as page:
        box = page.locator("#stick").bounding_box()
        assert box
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x, y - box["height"] / 2)
        drives(rig)
        page.mouse.up()
        rests(rig)
        for name in ("#stop", "#stick", "#state", "#top"):
            expect(page.locator(name)).to_be_in_viewport(ratio=1.0)


def test_a_release_and_a_press_at_once_are_both_heard(rig: Rig, browser: Browser, server: Process) -> None:
    with opened(browser, server) as page:
        page.evaluate(WATCH)
        page.evaluate(KEYS, ["keydown", "keyup", "keydown"])  # within one turn of the page's loop
        drives(rig)
        page.evaluate(KEYS, ["keyup"])
        rests(rig)
        assert page.evaluate("window.said").startswith("true,false,true")


def test_whoever_watches_stops_it_and_releases_it_with_intent(
    rig: Rig, browser: Browser, server: Process
) -> None:
    with opened(browser, server) as ann, opened(browser, server, "phone") as bob:
        ann.keyboard.down("ArrowUp")
        drives(rig)
        expect(bob.locator("#pages")).to_have_text(re.compile("page .* has the wheel, 2 pages are open"))
        bob.keyboard.down("ArrowDown")
        expect(bob.locator("#why")).to_have_text(re.compile("you are not obeyed: page .* has the wheel"))
        expect(bob.locator("#stick")).to_have_attribute("data-held", "false")
        bob.keyboard.up("ArrowDown")
        bob.get_by_role("button", name="STOP").click()
        rests(rig)
        for page in (ann, bob):
            expect(page.locator("#state")).to_have_text("stopped")
        bob.get_by_role("button", name="release").click()
        expect(ann.locator("#state")).to_have_text("idle")
        expect(ann.locator("#why")).to_have_text(re.compile("you are not obeyed: .*let go"))
        rests(rig)
        ann.keyboard.up("ArrowUp")
        ann.keyboard.down("ArrowUp")
        drives(rig)
        ann.keyboard.up("ArrowUp")
        rests(rig)


def test_the_demo_drives_from_a_page_too(rig: Rig, browser: Browser) -> None:
    demo = rig.run("demo", "--web")
    demo.says("open http://127.0.0.1:")
    with opened(browser, demo) as page:
        expect(page.locator("#camera")).to_have_text(re.compile("a second"))
        page.keyboard.down("ArrowUp")
        expect(page.locator("#moving")).to_have_text(re.compile(r"^\+0\.[1-9]"))
        page.keyboard.up("ArrowUp")
        expect(page.locator("#state")).to_have_text("idle")
    demo.signal(signal.SIGINT)
    assert demo.ends() == 130, demo.text


def test_a_page_with_another_token_says_where_the_right_one_is(browser: Browser, server: Process) -> None:
    found = re.search(r"http://[^#\s]+", server.text)
    assert found
    page = browser.new_page()
    page.goto(f"{found[0]}#t=wrong")
    expect(page.locator("#why")).to_have_text(
        "looking for the server: open the address that zteleop web has printed last"
    )
    page.close()
    server.says("the token is missing or wrong")


def test_what_is_said_on_the_bus_is_shown_as_it_comes_and_drawn_as_lines(
    rig: Rig, browser: Browser, server: Process
) -> None:
    with opened(browser, server) as page:
        page.locator("#tab-topics").click()
        odom = page.locator("#topics-list button", has_text="odom")
        expect(odom).to_contain_text(re.compile(r"(19|20|21)/s"))
        odom.click()
        expect(page.locator("#topics-echo")).to_contain_text("base_link")
        page.get_by_label("twist.twist.linear.x", exact=True).check()
        expect(page.locator("#plot-picture canvas")).to_be_visible()
        expect(page.locator("#plot-lines li")).to_have_text(re.compile("^odom twist.twist.linear.x"))
        page.keyboard.down("KeyW")  # the box that was ticked has the focus, and keeps no key
        drives(rig)
        speed = page.locator("#plot-lines output")
        expect(speed).to_have_text(re.compile(r"^0\.[2-9]"))
        page.keyboard.up("KeyW")
        rests(rig)
        expect(speed).to_have_text("0")
        with page.expect_download() as saved:
            page.locator("#plot-save").click()
        head, *rows = saved.value.path().read_text().splitlines()
        assert head == "time_s,odom twist.twist.linear.x"
        times, speeds = zip(*(map(float, row.split(",")) for row in rows), strict=True)
        assert list(times) == sorted(times)
        assert max(speeds) > 0.2
        page.locator("#plot-lines button", has_text="\u00d7").click()
        expect(page.locator("#plot-picture")).to_be_hidden()
        expect(page.get_by_label("twist.twist.linear.x", exact=True)).not_to_be_checked()
        page.locator("#topics-list button", has_text=re.compile("^stop")).click()
        expect(page.locator("#topics-echo")).to_have_text("stop: waits for what is said next")


def test_a_parameter_is_changed_by_a_slider_and_the_robot_has_the_last_word(
    rig: Rig, browser: Browser, server: Process
) -> None:
    with opened(browser, server) as page, opened(browser, server) as other:
        for one in (page, other):
            one.locator("#tab-parameters").click()
        speed, shown = (one.get_by_label("limits.speed", exact=False).first for one in (page, other))
        expect(speed).to_be_visible()
        most = speed.evaluate("slider => slider.value")
        speed.evaluate(SLIDE, "0.5")
        expect(shown).to_have_value("0.5")
        page.keyboard.down("KeyW")
        drives(rig)
        expect(page.locator("#allowed")).to_contain_text("at most 0.50 m/s")
        expect(page.locator("#forward-says")).to_have_text("0.15 m/s")  # 30 % of what it may
        page.keyboard.up("KeyW")
        rests(rig)
        speed.evaluate(SLIDE, most)
        expect(shown).to_have_value(most)


def test_what_the_robot_says_in_words_is_kept_line_by_line(
    rig: Rig, browser: Browser, server: Process
) -> None:
    node = rig.node("nose")
    with opened(browser, server) as page:
        page.locator("#tab-log").click()
        for number in range(8):
            node.log.info(f"smells {number} roses")
        node.log.warn("smells smoke")
        expect(page.locator("#log tr").first).to_contain_text("smells smoke")
        expect(page.locator("#log tr", has_text="roses")).to_have_count(8)
        page.get_by_label("warnings only").check()
        expect(page.locator("#log tr", has_text="roses").first).to_be_hidden()
        expect(page.locator("#log tr", has_text="smoke")).to_be_visible()
        expect(page.locator("#link")).to_contain_text("of 20 beats a second")


def test_what_a_robot_feels_is_told_where_it_says_so(rig: Rig, browser: Browser, server: Process) -> None:
    node = rig.node("skin")
    header = Header(Time(0, 0), "bump_front_left")
    with opened(browser, server) as page:
        expect(page.locator("#dangers")).to_be_hidden()
        dangers = node.publisher("hazard_detection", HazardDetectionVector)
        dangers.publish(HazardDetectionVector(header, [HazardDetection(header, 1)]))
        expect(page.locator("#dangers")).to_have_text("bump front left")
        dangers.publish(HazardDetectionVector(header, []))
        expect(page.locator("#dangers")).to_have_text("none")
        buttons = InterfaceButtons.zero()
        buttons.button_1.is_pressed = True
        node.publisher("interface_buttons", InterfaceButtons).publish(buttons)
        expect(page.locator("#buttons")).to_have_text("button 1")


def test_all_robots_are_a_table_with_who_operates_them(rig: Rig, browser: Browser, server: Process) -> None:
    with opened(browser, server) as page:
        page.locator("#tab-robots").click()
        row = page.locator("#room-robots tbody tr")
        expect(row).to_have_text(re.compile("^bench \\(this one\\)idlenobody"))
        page.keyboard.down("KeyW")
        expect(row).to_contain_text(re.compile(r"drivingweb \w{4}"))
        page.keyboard.up("KeyW")
        rests(rig)
        expect(row).to_contain_text("idlenobody")


def test_a_picture_that_is_paused_stays(rig: Rig, browser: Browser, server: Process) -> None:
    with opened(browser, server) as page:
        page.locator("#tab-topics").click()
        page.locator("#topics-list button", has_text="beat").click()
        page.get_by_label("time", exact=True).check()
        value = page.locator("#plot-lines output")
        expect(value).not_to_have_text("-")
        pictured = "document.querySelector('#plot-picture canvas').toDataURL()"
        page.locator("#plot-pause").click()
        before = page.evaluate(pictured)
        expect(page.locator("#topics-list button", has_text="beat")).to_contain_text("/s")
        page.wait_for_timeout(300)  # in which it would have been drawn six times
        assert page.evaluate(pictured) == before
        page.locator("#plot-pause").click()
        until(lambda: page.evaluate(pictured) != before, "it goes on")


def test_nodes_and_topics_are_a_drawing_in_which_a_topic_can_be_chosen(
    rig: Rig, browser: Browser, server: Process
) -> None:
    with opened(browser, server) as page:
        page.locator("#tab-graph").click()
        expect(page.locator("#room-topics")).to_be_hidden()
        nodes = page.locator("#graph .node")
        for name in ("actuator", "sim", "web", "watchdog"):
            expect(nodes.filter(has_text=name).first).to_be_visible()
        expect(page.locator("#graph .rate").filter(has_text=re.compile(r"^\d+/s$")).first).to_be_visible()
        assert page.locator("#graph .arrow.alive").count() > 3
        page.locator("#graph .topic").filter(has_text="vehicle").click()
        expect(page.locator("#room-topics")).to_be_visible()
        expect(page.locator("#topics-echo")).to_contain_text("ackermann")
        expect(page.locator("#graph")).to_be_hidden()


PHONE = """() => {
    window.felt = [];
    navigator.vibrate = (times) => window.felt.push(times);
    window.awake = 0;
    const wakeLock = { request: async () => { window.awake += 1; return new EventTarget(); } };
    Object.defineProperty(navigator, "wakeLock", { value: wakeLock });
}"""
"""what a phone has, and this browser has not"""
TILT = """([beta, gamma]) => {
    window.dispatchEvent(new DeviceOrientationEvent("deviceorientation", { beta, gamma }));
}"""


def test_a_phone_drives_by_being_tilted_stays_awake_and_is_felt_when_driving_ends(
    rig: Rig, browser: Browser, server: Process
) -> None:
    with opened(browser, server, "phone", has_touch=True, is_mobile=True, script=f"({PHONE})()") as page:
        button = page.locator("#tilt")
        expect(button).to_be_visible()
        about = {"pointerId": 1, "bubbles": True}
        button.evaluate("button => button.setPointerCapture = () => {}")  # which only a real finger has
        button.dispatch_event("pointerdown", about)
        page.evaluate(TILT, [40, 0])
        assert rig.ticks == tuple(NEUTRAL), "as it is held at first, it rests"
        page.evaluate(TILT, [10, -20])
        drives(rig)
        until(lambda: (rig.ticks[STEERING] or 0) > NEUTRAL[STEERING], "it steers to the left")
        button.dispatch_event("pointerup", about)
        rests(rig)
        page.evaluate(TILT, [-40, 0])
        rests(rig)
        button.dispatch_event("pointerdown", about)
        page.evaluate(TILT, [40, 0])
        page.evaluate(TILT, [10, 0])
        drives(rig)
        assert page.evaluate("window.awake") == 1
        assert page.evaluate("window.felt") == []
        page.locator("#stop").dispatch_event("click")
        rests(rig)
        until(lambda: page.evaluate("window.felt.length") == 1, "it is felt")
        button.dispatch_event("pointerup", about)
        page.locator("#release").click()
        expect(page.locator("#state")).to_have_text("idle")


def test_a_computer_offers_no_tilting(browser: Browser, server: Process) -> None:
    with opened(browser, server) as page:
        expect(page.locator("#tilt")).to_be_hidden()
