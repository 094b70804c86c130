"""What half an hour of attacks must not leave behind is seen where it is left."""

import os
import subprocess
from pathlib import Path

from faults.siege import MOST, MOST_OF_DOOR, differences
from faults.usage import Usage, usage

ROBOT = {"watchdog": Usage(1, 9.0, 20, 2), "door": Usage(2, 30.0, 22, 8)}


def test_what_is_the_same_is_nothing_to_tell() -> None:
    assert list(differences(ROBOT, ROBOT | {"door": Usage(2, 30.0 + MOST_OF_DOOR, 22, 8)})) == []


def test_what_a_process_has_taken_and_kept_is_told() -> None:
    grown = ROBOT | {"watchdog": Usage(1, 9.1 + MOST, 21, 3)}
    assert list(differences(ROBOT, grown)) == [
        "the watchdog has grown from 9.0 to 19.1 MB",
        "the watchdog had 20 files open, and has 21",
        "the watchdog had 2 threads, and has 3",
    ]


def test_another_watchdog_and_a_door_that_is_gone_are_told() -> None:
    assert list(differences(ROBOT, {"watchdog": Usage(3, 9.0, 20, 2)})) == [
        "there is no longer a door",
        "the watchdog is another",
    ]


def test_files_and_threads_and_memory_of_a_process_and_its_children_are_counted(tmp_path: Path) -> None:
    own = os.getpid()
    before = usage(own)["watchdog"]
    with (tmp_path / "held").open("w"), subprocess.Popen(["sleep", "60"]) as child:
        found = usage(own)
        child.kill()
    assert before.pid == own
    assert found["watchdog"].files >= before.files + 1
    assert found["watchdog"].mb > 1
    assert len(found) >= 2
