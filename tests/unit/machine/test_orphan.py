"""A process whose starter dies is told so at once, though a thread of the starter lives a little longer."""

import signal
import subprocess
import sys

import pytest

CHILD = """
import os, time
from zteleop.machine import orphan
orphan.notice(lambda: (print("orphan", flush=True), os._exit(0)))
print("ready", flush=True)
time.sleep(30)
"""
STARTER = f"""
import subprocess, sys
subprocess.run([sys.executable, "-c", {CHILD!r}])
"""


@pytest.mark.skipif(sys.platform != "linux", reason="Linux alone tells")
def test_whoever_is_started_is_told_that_its_starter_was_killed() -> None:
    with subprocess.Popen([sys.executable, "-c", STARTER], stdout=subprocess.PIPE, text=True) as starter:
        assert starter.stdout
        assert starter.stdout.readline() == "ready\n"
        starter.send_signal(signal.SIGKILL)
        assert starter.stdout.read() == "orphan\n", "and it has ended as well"
