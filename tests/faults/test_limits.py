"""A machine that gives a process less than it needs: that is told with what to raise, and is nobody's bug."""

from rig import ZTELEOP, Process, Rig

TOO_FEW = 16


def test_an_actuator_that_may_open_too_few_files_says_so(rig: Rig) -> None:
    command = ["sh", "-c", f'ulimit -n {TOO_FEW}; exec "$@"', "sh", *ZTELEOP]
    bus = ["--robot", rig.robot, "--no-multicast-scouting", "--listen", rig.endpoint]
    actuator = Process([*command, "actuator", *bus], rig.environment, rig.folder)
    assert actuator.ends() == 1
    assert "open" in actuator.lines[-1]
    assert actuator.lines[-1].startswith("zteleop actuator: ")
    assert "(a bug" not in actuator.text
    actuator.close()
