"""README's program, run as it stands, on the bus that everybody gets by default."""

import os
import signal

from rig import NEUTRAL, Rig, readme_program, until


def test_the_program_drives_the_wheels_until_it_is_told_to_end(rig: Rig) -> None:
    rig.robot = f"readme-{os.getpid()}"  # others may be on this network
    actuator = rig.run("actuator", "--robot", rig.robot)
    actuator.says("obeys")
    program = rig.program(readme_program(rig.robot))
    until(lambda: rig.ticks[0] not in (None, NEUTRAL[0]) and rig.ticks[1] != NEUTRAL[1], "motion")
    program.signal(signal.SIGTERM)
    assert program.ends() == 128 + signal.SIGTERM
    until(lambda: rig.ticks == NEUTRAL, "neutral")
