"""The whole corpus on every topic of a robot with company: everybody lives, nothing moves, nobody shouts."""

import re
from collections.abc import Iterator
from itertools import cycle, product
from pathlib import Path

import msgspec
import pytest
import zenoh
from fuzz.reading import corpus, is_key, parts
from rig import NEUTRAL, Process, Rig, Watch, hear, repeating, until

from zteleop.bus import codec
from zteleop.bus.topics import TOPICS, topic_of
from zteleop.messages import Beat, Log, Stop, String, Twist

BLOCK = zenoh.CongestionControl.BLOCK
PATHS = [
    path
    for topic in TOPICS.values()
    for path in (
        [f"{topic.name}/{source}" for source in ("keyboard", "program")] if topic.command else [topic.name]
    )
]
EVERYBODY = [
    "robot/*/cmd_vel/**",
    "robot/bench/**",
    "robot/**",
    "**",
    "robot/b$*/pwm/key$*",
    "robot/*/stop",
    "robot/bench/*",
]
NAMES = [
    "",
    "*",
    "**",
    "$*",
    "\x1b[2J",
    "\x1b]0;owned\x07",
    "\n\r",
    "\u202e",
    "é漢",
    "x" * 3000,
    "@",
    "a b",
    "%s",
    "../..",
]
ASKS = 0.5
"""s for which a question stays open"""
BIG = [b"x" * 1_000_000, b"[" * 1_000_000, b'{"linear":' * 100_000, b"\xff" * 10_000_000]
GROWTH = 2 * 2**20
"""bytes that the actuator may keep of an attack"""
CLOSING = re.compile(
    r"\nthread 'app-\d' \(\d+\) panicked at \S*/dispatcher/resource\.rs:491:\d+:"
    r"\ncalled `Option::unwrap\(\)` on a `None` value(\n(note: run with|stack backtrace:| +\d+:| +at ).*)*"
)
"""What zenoh 1.10.2 says where a declaration arrives in the very instant in which it closes: its tables are
emptied between two looks at them (eclipse-zenoh/zenoh#2624). Once in thousands of commands, after the last
word of one; it has done what it should, and ends as it would have."""


class Company:
    """A robot, and everybody who listens to it."""

    def __init__(self, rig: Rig) -> None:
        self.rig, self.robot = rig, rig.actuator()
        self.seat = rig.keyboard()
        self.seat.shows("idle, nobody operates")
        self.others = [
            rig.join("sim"),
            rig.join("watchdog"),
            *(rig.join("echo", topic) for topic in ("cmd_vel", "drive_status", "log", "odom")),
            rig.join("echo", "--json", "why"),
        ]
        self.truth = rig.node("truth")
        self.words = 0
        self.last = self.truth.subscription("last", String)
        self.stranger = rig.session()
        self.last_word = self.stranger.declare_publisher(
            "robot/bench/last", encoding=codec.encoding_of(String), congestion_control=BLOCK
        )
        self.last_log = self.stranger.declare_publisher(
            "robot/bench/log", encoding=codec.encoding_of(Log), congestion_control=BLOCK
        )
        until(lambda: getattr(self.last_word.matching_status, "matching"), "who hears the last word")  # noqa: B009
        until(lambda: len(self.children) == 3, "an actuator, its door and its black box")
        self.found = self.children

    @property
    def children(self) -> set[int]:
        """The processes that the watchdog started."""
        pid = self.robot.process.pid
        return set(map(int, Path(f"/proc/{pid}/task/{pid}/children").read_text().split()))

    @property
    def memory(self) -> int:
        """The bytes that the actuator has of its own."""
        text = Path(f"/proc/{self.robot.child}/smaps_rollup").read_text()
        return sum(int(line.split()[1]) << 10 for line in text.splitlines() if line.startswith("Private_"))

    def hears_out(self) -> None:
        """Wait until the stranger's last word has come the way of all he said, and the robot goes on."""
        self.words += 1
        self.last_word.put(codec.encode(String(f"{self.words}")))
        hear(self.last, lambda word: word.data == f"{self.words}", "the last word")
        # The keyboard may still be reading what the stranger said as the robot, and lets go for it.
        word = f"word {self.words} is read"
        with repeating(lambda: self.last_log.put(codec.encode(log(word))), 0.1):
            self.seat.shows(word)
        hear(self.truth.subscription("beat", Beat), lambda beat: True, "a beat")

    def drives(self, key: str, pattern: tuple[int, int]) -> None:
        """Drive by the keyboard, as if nothing had happened."""
        self.seat.shows("idle, nobody operates", "[375, 370]")
        self.seat.type(key)
        until(lambda: self.rig.ticks == pattern, f"{key} on the chip")
        self.seat.type("x")
        until(lambda: self.rig.ticks == NEUTRAL, "neutral")

    def is_well(self) -> None:
        """Check that everybody lives and has said nothing but text."""
        assert self.children == self.found, self.robot.text
        for process in (self.robot, *self.others):
            assert process.process.poll() is None, process.text
            is_plain(process)
        assert self.seat.process.poll() is None
        assert b"\x1b]" not in self.seat.output
        assert b"Traceback" not in self.seat.output


def log(words: str) -> Log:
    """Return what a keyboard shows as it is."""
    said = Log.zero()
    said.name, said.level, said.msg = "actuator", Log.WARN, words
    return said


def is_plain(process: Process) -> None:
    assert all(line.isprintable() for line in process.lines)
    text = CLOSING.sub("", process.text) if process.process.poll() == 0 else process.text
    for word in ("Traceback", "panicked", "Exception", "a bug"):
        assert word not in text, text[-2000:]


@pytest.fixture(scope="module")
def company(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Company]:
    with Rig(tmp_path_factory.mktemp("fuzz")) as rig:
        yield Company(rig)


@pytest.fixture
def stranger(company: Company) -> zenoh.Session:
    return company.stranger


@pytest.fixture
def harmless(company: Company) -> Iterator[None]:
    """Judge an attack."""
    with Watch(company.rig) as watch:
        yield
        company.hears_out()
    assert watch.seen == {NEUTRAL}
    company.is_well()
    company.drives("a", (390, 370))


def replay(stranger: zenoh.Session) -> None:
    """Say every message of the corpus on every topic, as what it is and as what the topic takes."""
    attachments = cycle([None, *(file.read_bytes() for file in corpus("attachment"))])
    for file, path in product(corpus("message"), PATHS):
        encoding, payload = parts(file.read_bytes())
        accepted = topic_of(path).types[0]
        for said_as in (encoding, codec.encoding_of(accepted)):
            key = f"robot/bench/{path}"
            stranger.put(
                key, payload, encoding=said_as, attachment=next(attachments), congestion_control=BLOCK
            )


def test_the_corpus_on_every_topic(company: Company, stranger: zenoh.Session, harmless: None) -> None:
    replay(stranger)
    company.hears_out()
    before = company.memory
    replay(stranger)
    company.hears_out()
    assert company.memory - before < GROWTH


def test_what_is_too_large_on_every_topic(company: Company, stranger: zenoh.Session, harmless: None) -> None:
    before = company.memory
    for payload, path in product(BIG, PATHS):
        encoding = codec.encoding_of(topic_of(path).types[0])
        stranger.put(f"robot/bench/{path}", payload, encoding=encoding, congestion_control=BLOCK)
    company.hears_out()
    assert company.memory - before < 4 * GROWTH  # the allocator keeps some for the next one


def test_words_to_everybody_at_once(stranger: zenoh.Session, harmless: None) -> None:
    stop = Stop(engaged=True, id=1, by="x", why="x")
    for key, message in product(EVERYBODY, (Twist.planar(1.0, 1.0), stop)):
        encoding, payload = codec.encoding_of(type(message)), msgspec.json.encode(message)
        stranger.put(key, payload, encoding=encoding, attachment=bytes(48), congestion_control=BLOCK)
        stranger.delete(key, congestion_control=BLOCK)
    for path in PATHS:
        stranger.delete(f"robot/bench/{path}", congestion_control=BLOCK)


def test_names_that_are_more_than_names(stranger: zenoh.Session, harmless: None) -> None:
    for name, path in product(NAMES, PATHS):
        for key in (f"robot/{name}/{path}", f"robot/bench/{path}/{name}", f"robot/bench/{name}"):
            if is_key(key):
                said_as = name[:250]  # zenoh itself cannot send a longer one
                stranger.put(key, b"{}", encoding=said_as, attachment=name.encode(), congestion_control=BLOCK)


def test_tokens_of_strangers(company: Company, stranger: zenoh.Session, harmless: None) -> None:
    lines = [line for file in corpus("token") for line in file.read_text().split("\n")]
    keys = [f"robot/{line.replace('archangel', robot)}" for line in lines for robot in ("bench", "archangel")]
    names = [f"robot/{name}/live/node/actuator/{name}" for name in NAMES]
    tokens = [stranger.liveliness().declare_token(key) for key in (*keys, *names) if is_key(key)]
    shown = company.rig.join("list", "-t", "-v")
    assert shown.ends() == 0
    is_plain(shown)
    assert "/bench/cmd_vel" in shown.text
    for verb in ("why", "stop"):
        answer = company.rig.join(verb, *(["--release"] if verb == "stop" else []))
        assert answer.ends() == 0, answer.text
        is_plain(answer)
    for token in tokens:
        token.undeclare()  # type: ignore[no-untyped-call]


def test_the_journal_has_kept_only_text(company: Company) -> None:
    journal = company.rig.folder / "state_home" / "zteleop" / "robots" / "bench" / "journal.jsonl"
    until(lambda: journal.stat().st_size, "a journal")
    for line in journal.read_text().splitlines():
        assert line.isprintable()
        assert not line or msgspec.json.decode(line)


def test_questions_to_everybody(stranger: zenoh.Session, harmless: None) -> None:
    for key in ("**", "robot/**", "robot/bench/cmd_vel/*", "robot/bench/cmd_vel/keyboard"):
        list(stranger.get(key, payload=b"\xff" * 1000, encoding="x", attachment=bytes(48), timeout=ASKS))
        list(stranger.liveliness().get(key, timeout=ASKS))


@pytest.mark.parametrize("content", [b"", b"x", b"\xff" * 256 + bytes(16), bytes(5000)], ids=len)
def test_a_chip_file_that_somebody_overwrites_ends_nobody(company: Company, content: bytes) -> None:
    Path(company.rig.chip).write_bytes(content)
    until(lambda: company.rig.ticks == NEUTRAL, "neutral again")
    company.hears_out()
    company.is_well()
