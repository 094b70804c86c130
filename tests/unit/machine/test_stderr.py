"""With real pipes: what matters is what the kernel does when nobody reads."""

import os
import subprocess
import sys
import threading
import time

import pytest

from zteleop.machine.stderr import LINES, LineWriter, with_priority


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("actuator: info: obeys", "<6>actuator: info: obeys"),
        ("door: error: it ends: badly", "<3>door: error: it ends: badly"),
        ("actuator: warning: late", "<4>actuator: warning: late"),
        ("anything: else", "anything: else"),
        ("", ""),
    ],
)
def test_the_journal_reads_a_level_in_front(line: str, told: str) -> None:
    assert with_priority(line) == told


@pytest.mark.parametrize("journal", [True, False])
def test_a_level_stands_in_front_only_where_stderr_is_the_journals(journal: bool) -> None:
    ear, mouth = os.pipe()
    file = os.fstat(mouth)
    stream = f"{file.st_dev}:{file.st_ino if journal else 1}"
    code = "from zteleop.machine import stderr; stderr.tell('door: error: ends'); stderr.flush()"
    subprocess.run(
        [sys.executable, "-c", code], stderr=mouth, env=os.environ | {"JOURNAL_STREAM": stream}, check=True
    )
    os.close(mouth)
    assert os.read(ear, 100) == (b"<3>door: error: ends\n" if journal else b"door: error: ends\n")
    os.close(ear)


def test_lines_are_written_in_their_order() -> None:
    ear, mouth = os.pipe()
    writer = LineWriter(mouth)
    for line in ("one", "", "three"):
        writer.tell(line)
    writer.flush(1.0)
    assert os.read(ear, 100).split() == [b"one", b"three"]
    os.close(ear)
    os.close(mouth)


def test_a_pipe_that_nobody_reads_holds_up_nobody() -> None:
    ear, mouth = os.pipe()
    writer = LineWriter(mouth)
    began = time.monotonic()
    for _ in range(100 * LINES):
        writer.tell("x" * 100)
    writer.flush(0.0)
    assert time.monotonic() - began < 1.0
    while len(os.read(ear, 65536)) == 65536:  # so that its thread can end
        pass
    writer.flush(1.0)
    os.close(ear)
    os.close(mouth)


def test_a_reader_that_is_gone_is_no_error() -> None:
    ear, mouth = os.pipe()
    os.close(ear)
    writer = LineWriter(mouth)
    writer.tell("nobody hears this")
    writer.flush(1.0)
    os.close(mouth)


def test_all_its_lines_are_written_by_one_thread_that_is_started_once() -> None:
    ear, mouth = os.pipe()
    writer = LineWriter(mouth)
    writer.tell("one")
    writer.flush(1.0)
    thread = writer._thread
    before = threading.active_count()
    for _ in range(3):
        writer.tell("more")
        writer.flush(1.0)
    assert (writer._thread, threading.active_count()) == (thread, before)
    assert os.read(ear, 100).split() == [b"one", b"more", b"more", b"more"]
    os.close(ear)


@pytest.mark.skipif(sys.platform != "linux", reason="asks Linux")
def test_its_thread_is_an_ordinary_one_whoever_speaks_first() -> None:
    """SCHED_BATCH, which anybody may ask for, stands for whatever it would inherit."""
    ear, mouth = os.pipe()
    writer = LineWriter(mouth)

    def speak() -> None:
        os.sched_setscheduler(0, os.SCHED_BATCH, os.sched_param(0))
        writer.tell("first")

    speaker = threading.Thread(target=speak)
    speaker.start()
    speaker.join()
    writer.flush(1.0)
    assert writer._thread
    assert writer._thread.native_id
    assert os.sched_getscheduler(writer._thread.native_id) == os.SCHED_OTHER
    os.close(ear)
    os.close(mouth)
