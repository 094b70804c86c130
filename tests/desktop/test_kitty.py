"""A real terminal on a real screen, with keys that a finger holds: in the machine itself, and through ssh."""

import os
import shlex
import shutil
import signal
import subprocess
from collections.abc import Iterator
from contextlib import AbstractContextManager
from pathlib import Path

import pytest
from desk import CLASS, QUIET, Desk, loses_the_focus, screen, sits
from processes import ZTELEOP, descendants
from rig import NEUTRAL, Rig, every, free_port, until

NEEDS = ("Xvfb", "kitty", "xdotool", "ssh", "ssh-keygen", "/usr/sbin/sshd")
MISSING = [program for program in NEEDS if not shutil.which(program)]
pytestmark = pytest.mark.skipif(
    bool(MISSING), reason=f"not here: {', '.join(MISSING)} (Debian: xvfb kitty xdotool openssh-server)"
)
PLAIN = ["--config", "NONE", "-o", "update_check_interval=0", "-o", "confirm_os_window_close=0"]


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("kitty")) as bench:
        bench.actuator()
        yield bench


@pytest.fixture(scope="module")
def display() -> Iterator[str]:
    with screen() as name:
        yield name


def desk(rig: Rig, display: str, command: list[str]) -> AbstractContextManager[Desk]:
    """Run a command in a kitty."""
    about = {"KITTY_CACHE_DIRECTORY": str(rig.folder)}
    return sits(rig, display, ["kitty", *PLAIN, "--class", CLASS, *command], about)


def keyboard(rig: Rig) -> list[str]:
    return [*ZTELEOP, "keyboard", *rig.bus_options()]


def drives_and_steers(rig: Rig, desk: Desk) -> None:
    """Hold two keys, let go of one, and then of the other; see the wheels follow."""

    def both() -> bool:
        return rig.ticks[0] > NEUTRAL[0] + 20 and rig.ticks[1] > NEUTRAL[1] + 5

    desk.hold("Left")
    until(both, "both")
    for _ in every(0.1, 15):  # no repeat tells of the key that was pressed first
        pass
    until(both, "both still")
    desk.let_go("Left")
    until(lambda: rig.ticks[0] == NEUTRAL[0] and rig.ticks[1] > NEUTRAL[1] + 5, "straight on")
    desk.let_go("Up")
    until(lambda: rig.ticks == NEUTRAL, "rest")


def test_two_keys_that_are_held_drive_and_steer(rig: Rig, display: str) -> None:
    with desk(rig, display, keyboard(rig)) as here:
        here.drives_at_last("Up")
        drives_and_steers(rig, here)


def test_with_the_focus_everything_is_let_go(rig: Rig, display: str) -> None:
    with desk(rig, display, keyboard(rig)) as here:
        loses_the_focus(rig, here)


@pytest.fixture(scope="module")
def ssh(tmp_path_factory: pytest.TempPathFactory) -> Iterator[list[str]]:
    """The beginning of a command that runs another one through ssh, on this machine."""
    folder, port, user = tmp_path_factory.mktemp("ssh"), free_port(), os.environ.get("USER", "root")
    for name in ("host", "person"):
        subprocess.run(["ssh-keygen", "-qt", "ed25519", "-N", "", "-f", str(folder / name)], check=True)
    (folder / "config").write_text(
        f"Port {port}\nListenAddress 127.0.0.1\nHostKey {folder}/host\nPidFile none\nStrictModes no\n"
        f"AuthorizedKeysFile {folder}/person.pub\nUsePAM no\nPermitRootLogin yes\n"
    )
    if os.geteuid() == 0:
        Path("/run/sshd").mkdir(exist_ok=True)
    server = subprocess.Popen(["/usr/sbin/sshd", "-D", "-f", str(folder / "config")], **QUIET)
    options = ["StrictHostKeyChecking=no", f"UserKnownHostsFile={folder}/known", "LogLevel=ERROR"]
    flags = [word for option in options for word in ("-o", option)]
    command = ["ssh", "-tt", *flags, "-i", str(folder / "person"), "-p", str(port), f"{user}@127.0.0.1"]
    until(lambda: subprocess.run([*command, "true"], check=False, **QUIET).returncode == 0, "sshd")
    yield command
    server.terminate()
    server.wait()


def test_it_is_the_same_through_ssh_and_a_stalled_link_lets_go(
    rig: Rig, display: str, ssh: list[str]
) -> None:
    far = f"cd {rig.folder} && exec {shlex.join(keyboard(rig))}"
    with desk(rig, display, [*ssh, far]) as here:
        here.drives_at_last("Up")
        drives_and_steers(rig, here)
        here.drives_at_last("Up")
        client = next(pid for pid in descendants(here.program.pid) if command_line(pid).startswith("ssh"))
        os.kill(client, signal.SIGSTOP)
        until(lambda: rig.ticks == NEUTRAL, "rest")
        os.kill(client, signal.SIGCONT)
        for _ in every(0.1, 10):
            assert rig.ticks == NEUTRAL, "the key is still down, and arms nothing"


def command_line(pid: int) -> str:
    return Path(f"/proc/{pid}/cmdline").read_bytes().replace(b"\0", b" ").decode()
