"""What docs/simulation.md has people type for a Create 3, in its order, as it stands there."""

import re
import shlex
from pathlib import Path

import pytest
from rig import Rig

PAGE = (Path(__file__).parents[2] / "docs/simulation.md").read_text()
CHAPTER = PAGE[PAGE.index("## A Create 3 without one") : PAGE.index("## A scene of your own")]
ACTUATOR, SIM, CIRCLE, PRESS, ECHO = (
    shlex.split(line) for line in re.findall(r"^    zteleop (.+)$", CHAPTER, re.MULTILINE)
)


def test_a_newcomer_drives_the_circle_and_presses_a_button(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    with Rig(tmp_path_factory.mktemp("page"), "lab") as rig:
        where = ["--no-multicast-scouting", "--connect", rig.endpoint]
        actuator = rig.run(*ACTUATOR, "--no-multicast-scouting", "--listen", rig.endpoint)
        actuator.says("lab obeys")
        sim = rig.run(*SIM, *where)
        sim.says("the actuator of lab is heard, and moves it")
        circle = rig.result(*CIRCLE, *where)
        assert (circle.returncode, circle.stderr) == (0, "")
        radius = re.search(r"a radius of (\d\.\d\d) m", circle.stdout)
        assert radius
        assert float(radius[1]) == pytest.approx(0.5, abs=0.02)
        assert "button_1 is down" in rig.result(*PRESS, *where).stdout
        rig.run(*ECHO, *where).says("True")
        assert "it stands at" not in sim.text, "nothing is in the way of that circle"
