"""The Tab key, in a shell that everybody has."""

import subprocess

from rig import PATIENCE, ZTELEOP, Rig

ASKED = """
zteleop() { %s "$@"; }
eval "$(zteleop completion bash)"
COMP_WORDS=(zteleop "$@") COMP_CWORD=$#
_zteleop
printf '%%s\\n' "${COMPREPLY[@]}"
"""


def completed(rig: Rig, *words: str) -> list[str]:
    command = ["bash", "--norc", "-c", ASKED % " ".join(ZTELEOP), "bash", *words]
    done = subprocess.run(
        command,
        env=rig.environment,
        cwd=rig.folder,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=True,
    )
    return done.stdout.split()


def test_bash_completes_verbs_options_types_topics_and_robots(rig: Rig) -> None:
    rig.actuator()
    assert completed(rig, "topic", "ec") == ["echo"]
    assert completed(rig, "keyboard", "--dri") == ["--drive"]
    assert "geometry_msgs/msg/TwistStamped" in completed(rig, "pub", "x", "geometry_msgs/msg/Twist")
    assert completed(rig, "echo", *rig.bus_options(), "bench/drive_s") == ["bench/drive_status"]
    assert completed(rig, "stop", *rig.bus_options()[2:], "be") == ["bench"]
    assert completed(rig, "check", "conf") == [], "a file is the shell's to complete"
