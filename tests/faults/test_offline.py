"""A laptop in no network: what runs on it finds each other all the same."""

import os
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from faults.link.network import inside, obstacle
from processes import ZTELEOP

WITHIN = 30
"""s for two processes to start, meet and be done on a busy machine"""


@pytest.fixture
def machine(tmp_path: Path) -> Iterator[list[str]]:
    """Return what to put in front of a command so that it runs where there is no network."""
    if why := obstacle():
        pytest.skip(why)
    name = f"zteleop-{os.getpid()}-0-offline"
    subprocess.run(["ip", "netns", "add", name], check=True)
    try:
        subprocess.run(["ip", "-n", name, "link", "set", "lo", "up"], check=True)
        yield [*inside(name), "env", f"XDG_RUNTIME_DIR={tmp_path}", f"HOME={tmp_path}"]
    finally:
        subprocess.run(["ip", "netns", "del", name], check=True)


def test_two_programs_on_a_machine_without_a_network_hear_each_other(machine: list[str]) -> None:
    echo = [*machine, *ZTELEOP, "echo", "/abe/chatter", "--once", "--timeout", str(WITHIN)]
    pub = [*machine, *ZTELEOP, "pub", "/abe/chatter", "String", "{data: hello}", "-1", "-w", "1"]
    with subprocess.Popen(echo, stdout=subprocess.PIPE, text=True) as listener:
        said = subprocess.run(pub, check=False, timeout=WITHIN)
        heard, _ = listener.communicate(timeout=WITHIN)
    assert said.returncode == 0
    assert "data: hello" in heard
