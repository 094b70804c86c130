"""README's program, run as it stands, on the bus that everybody gets by default."""

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

from rig import NEUTRAL, Rig, until

ROOT = Path(__file__).parents[2]


def blocks() -> list[str]:
    return re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)


def test_the_program_drives_the_wheels_until_it_is_told_to_end(rig: Rig) -> None:
    rig.robot = f"readme-{os.getpid()}"  # others may be on this network
    (program,) = blocks()
    actuator = rig.run("actuator", "--robot", rig.robot)
    actuator.says("obeys")
    script = rig.folder / "program.py"
    script.write_text(program.replace("archangel", rig.robot))
    process = subprocess.Popen([sys.executable, str(script)], env=rig.environment)
    try:
        until(lambda: rig.ticks[0] not in (None, NEUTRAL[0]) and rig.ticks[1] != NEUTRAL[1], "motion")
        process.send_signal(signal.SIGTERM)
        assert process.wait(5) == 128 + signal.SIGTERM
    finally:
        process.kill()
        process.wait()
    until(lambda: rig.ticks == NEUTRAL, "neutral")
