"""`zteleop keyboard --input`: keys from a pipe, and from where there are none."""

import subprocess

from rig import NEUTRAL, PATIENCE, ZTELEOP, Rig, until


def test_a_script_drives_by_a_pipe_and_its_end_is_neutral(rig: Rig) -> None:
    rig.actuator()
    command = [*ZTELEOP, "keyboard", "--input", "stdin", *rig.bus_options()]
    lines: list[str] = []
    with subprocess.Popen(
        command,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=rig.environment,
        cwd=rig.folder,
    ) as keyboard:
        assert keyboard.stdin
        assert keyboard.stdout
        while not lines or "idle" not in lines[-1]:
            lines.append(keyboard.stdout.readline().decode())
        keyboard.stdin.write(b"ww\x1b[D")
        keyboard.stdin.flush()
        until(lambda: rig.ticks == (390, 375), "levers on the chip")
        keyboard.stdin.close()
        until(lambda: rig.ticks == NEUTRAL, "neutral")
        assert keyboard.wait(PATIENCE) == 0


def test_without_a_keyboard_at_this_machine_evdev_says_so(rig: Rig) -> None:
    rig.actuator()
    keyboard = rig.keyboard("--input", "evdev")
    assert keyboard.ends() == 1
    assert b"a keyboard" in keyboard.output
    keyboard.is_as_found()
