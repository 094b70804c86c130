"""A real terminal on a real screen, with keys that a finger holds: in the machine itself, and through ssh."""

import os
import shlex
import shutil
import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from processes import ZTELEOP, descendants
from rig import NEUTRAL, Rig, every, free_port, until

NEEDS = ("Xvfb", "kitty", "xdotool", "ssh", "ssh-keygen", "/usr/sbin/sshd")
MISSING = [program for program in NEEDS if not shutil.which(program)]
pytestmark = pytest.mark.skipif(
    bool(MISSING), reason=f"not here: {', '.join(MISSING)} (Debian: xvfb kitty xdotool openssh-server)"
)
QUIET = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
PLAIN = ["--config", "NONE", "-o", "update_check_interval=0", "-o", "confirm_os_window_close=0"]


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("kitty")) as bench:
        bench.actuator()
        yield bench


@pytest.fixture(scope="module")
def display() -> Iterator[str]:
    """A screen that nobody sees."""
    reading, writing = os.pipe()
    command = ["Xvfb", "-displayfd", str(writing), "-screen", "0", "1024x768x24", "-nolisten", "tcp"]
    server = subprocess.Popen([*command, "+extension", "GLX"], pass_fds=[writing], **QUIET)
    os.close(writing)
    with os.fdopen(reading) as number:
        yield f":{number.readline().strip()}"
    server.terminate()
    server.wait()


class Desk:
    """A kitty window in which a keyboard drives, and fingers on the keys."""

    def __init__(self, rig: Rig, display: str, command: list[str]) -> None:
        self._rig = rig
        self._environment = {
            **rig.environment,
            **{"DISPLAY": display, "LIBGL_ALWAYS_SOFTWARE": "1", "LC_ALL": "C.UTF-8"},
            "KITTY_CACHE_DIRECTORY": str(rig.folder),
        }
        self.kitty = subprocess.Popen(
            ["kitty", *PLAIN, "--class", "desk", *command], env=self._environment, cwd=rig.folder, **QUIET
        )

    def focus(self) -> None:
        """Wait for the window; one that is not on the screen yet cannot have the focus."""
        self._do("search", "--sync", "--onlyvisible", "--class", "desk", "windowfocus", "--sync")

    def _do(self, *words: str) -> None:
        subprocess.run(["xdotool", *words], env=self._environment, check=True, timeout=60, **QUIET)

    def hold(self, *keys: str) -> None:
        self._do("keydown", *keys)

    def let_go(self, *keys: str) -> None:
        self._do("keyup", *keys)

    def drives_at_last(self, key: str) -> None:
        """Hold a key until the keyboard is there and the wheels turn; what came too early is let go first."""

        def turns() -> bool:
            self.let_go(key)
            self.hold(key)
            return any(self._rig.ticks[1] != NEUTRAL[1] for _ in every(0.05, 20))

        until(turns, "a keyboard that drives")

    def look_elsewhere(self) -> None:
        """Take the focus away from the window, as another one does."""
        self._do("search", "--maxdepth", "0", ".*", "windowfocus")

    def close(self) -> None:
        left = descendants(self.kitty.pid)
        self.kitty.terminate()
        self.kitty.wait()
        until(
            lambda: not any(Path(f"/proc/{pid}").exists() for pid in left),
            "the end of what ran in the window",
        )


@contextmanager
def desk(rig: Rig, display: str, command: list[str]) -> Iterator[Desk]:
    desk = Desk(rig, display, command)
    try:
        desk.focus()
        yield desk
    finally:
        for key in ("Up", "Left", "Right"):
            desk.let_go(key)
        desk.close()
        until(lambda: rig.ticks == NEUTRAL, "rest")


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
        here.drives_at_last("Up")
        here.look_elsewhere()
        until(lambda: rig.ticks == NEUTRAL, "rest")
        here.focus()
        for _ in every(0.1, 10):
            assert rig.ticks == NEUTRAL, "the key is still down, and arms nothing"
        here.let_go("Up")
        here.drives_at_last("Up")


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
        client = next(pid for pid in descendants(here.kitty.pid) if command_line(pid).startswith("ssh"))
        os.kill(client, signal.SIGSTOP)
        until(lambda: rig.ticks == NEUTRAL, "rest")
        os.kill(client, signal.SIGCONT)
        for _ in every(0.1, 10):
            assert rig.ticks == NEUTRAL, "the key is still down, and arms nothing"


def command_line(pid: int) -> str:
    return Path(f"/proc/{pid}/cmdline").read_bytes().replace(b"\0", b" ").decode()
