"""README's program, run as it stands, on the bus that everybody gets by default."""

import os
import signal

from rig import NEUTRAL, ROOT, Rig, readme_program, until


def test_the_program_drives_the_wheels_until_it_is_told_to_end(rig: Rig) -> None:
    rig.robot = f"readme-{os.getpid()}"  # others may be on this network
    actuator = rig.run("actuator", "--robot", rig.robot)
    actuator.says("obeys")
    program = rig.program(readme_program(rig.robot))
    until(lambda: rig.ticks[0] not in (None, NEUTRAL[0]) and rig.ticks[1] != NEUTRAL[1], "motion")
    program.signal(signal.SIGINT)
    assert program.ends() == 128 + signal.SIGINT
    assert program.text == ""
    until(lambda: rig.ticks == NEUTRAL, "neutral")


def test_the_program_is_the_first_of_the_examples() -> None:
    example = (ROOT / "examples/publisher.py").read_text()
    assert example == f'"""Drive in a curve until Ctrl-C."""\n\n{readme_program("archangel")}'
