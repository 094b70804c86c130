"""A robot whose disk is full, or fills up while it drives, obeys and stops all the same."""

import os
import subprocess
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from rig import NEUTRAL, Rig, repeating, until

from zteleop.messages import DriveStatus, Pwm

FORWARD, DRIVEN = Pwm(390, 400), (390, 400)
SIZE = "256k"


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of its own that is soon full; only root may mount one."""
    place = tmp_path / "disk"
    place.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", f"size={SIZE}", "tmpfs", place], capture_output=True
    )
    if mounted.returncode:
        pytest.skip(f"a full disk needs mount, and root: {mounted.stderr.decode().strip()}")
    yield place
    subprocess.run(["umount", "--lazy", place], check=True)


def fill(disk: Path) -> None:
    ballast = os.open(disk / "ballast", os.O_WRONLY | os.O_CREAT)
    with suppress(OSError):
        while os.write(ballast, b"x" * 4096):
            pass
    os.close(ballast)
    assert os.statvfs(disk).f_bavail == 0


@pytest.mark.parametrize("when", ["before it starts", "while it drives"])
def test_a_full_disk_holds_up_neither_driving_nor_a_stop(tmp_path: Path, disk: Path, when: str) -> None:
    with Rig(tmp_path) as rig:
        rig.environment["XDG_STATE_HOME"] = str(disk)
        if when == "before it starts":
            fill(disk)
        robot = rig.actuator()
        node = rig.node()
        rig.hear(node)
        statuses = node.subscription("drive_status", DriveStatus)
        publisher = node.publisher("pwm", Pwm, source="keyboard")
        with repeating(lambda: publisher.publish(FORWARD), 0.02):
            until(lambda: rig.ticks == DRIVEN, "the command on the chip")
            if when == "while it drives":
                fill(disk)
            stopped = rig.result("stop", *rig.bus_options())
            assert stopped.returncode == 0, stopped.stderr
            assert rig.ticks == NEUTRAL
            robot.says("No space left on device")
            killed = robot.child
            assert killed
            os.kill(killed, 9)  # the next actuator learns of a stop that is on no disk
            until(lambda: robot.child not in (None, killed), "another actuator")
            until(lambda: (s := statuses.newest()) and s.state == "stopped", "the stop is known again")
            assert rig.ticks == NEUTRAL
