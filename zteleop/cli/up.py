import argparse
import shlex
import sys
from collections.abc import Mapping
from os import environ
from pathlib import Path
from shutil import which

from zteleop import config
from zteleop.bus.escape import printable
from zteleop.cli import VERBS, find_verb
from zteleop.cli._completing import places_of
from zteleop.errors import ConfigError, nearest
from zteleop.machine import signals
from zteleop.machine.launch import Launch, Program
from zteleop.terminal.capabilities import wants_color
from zteleop.text.toml_places import place, places

EXAMPLES = (
    "zteleop up",
    "zteleop up --systemd",
)
NEEDS_TERMINAL = ("demo", "gamepad", "keyboard", "keys")
PAUSES_NOTHING = "Ctrl-Z would pause nothing that it started, only who starts it again; Ctrl-C ends all of it"
LEASHED = ("actuator", "camera", "odometry", "sim")
"""verbs that end when whoever started them does"""
COLORS = ("36", "33", "35", "32", "34")
UNIT = """\
# /etc/systemd/system/zteleop-{name}.service
[Unit]
Description=zteleop: {name}

[Service]
{kind}WorkingDirectory={place}
ExecStart={command}
Restart=on-failure
RestartSec=1

[Install]
WantedBy=multi-user.target
"""
OF_A_ROBOT = """\
# deploy/zteleop.service says more for a Pi: its user, its limits, and neutral whatever the end was
Type=notify
NotifyAccess=main
WatchdogSec=2
WatchdogSignal=SIGKILL
KillMode=mixed
SuccessExitStatus=143
"""
"""for an actuator, whose watchdog says that it lives; deploy/zteleop.service has more, for a Pi"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "file", metavar="FILE", nargs="?", type=Path, help="settings (default: ./config.toml)"
    )
    parser.add_argument("--systemd", action="store_true", help="print a unit file for each, and end")


def run(arguments: argparse.Namespace) -> int:
    path = arguments.file or config.found()
    launch = config.load(path).launch
    if not launch or path is None:
        where = path or "config.toml"
        raise ConfigError(f'nothing to start: write [launch] into {where}, such as robot = "actuator"')
    programs = programs_of(launch, path)
    if arguments.systemd:
        print("\n".join(unit(name, one) for name, one in programs.items()), end="")
        return 0
    signals.stay(lambda: print(f"zteleop up: {PAUSES_NOTHING}", file=sys.stderr, flush=True))
    return Launch(programs, teller(programs)).run()


def programs_of(launch: Mapping[str, str], path: Path) -> dict[str, Program]:
    """Return what each entry of a file's [launch] starts; raises ConfigError, a line for each mistake."""
    found, mistakes = dict[str, Program](), list[str]()
    written = places(path.read_text("utf-8")) if launch else {}
    for name, words in launch.items():
        try:
            found[name] = program(name, words, path)
            _expect_file(name, words)
        except ConfigError as error:
            where = place(written, ("launch", name)) or ()
            mistakes.append(f"{':'.join(map(str, (path, *where)))}: {error}")
    if mistakes:
        raise ConfigError("\n".join(mistakes))
    return found


def program(name: str, words: str, path: Path) -> Program:
    """Return what an entry of [launch] starts: a verb of zteleop, or any other program.

    Raises ConfigError for words that are none, and for a verb that wants a terminal.
    """
    try:
        typed = shlex.split(words)
    except ValueError as error:
        raise ConfigError(f"launch.{name}: {str(error).lower()} in {words!r}") from None
    if not typed:
        raise ConfigError(f'launch.{name}: expected a command, such as "actuator", found nothing')
    verb, rest = find_verb(typed)
    if verb in NEEDS_TERMINAL:
        raise ConfigError(f"launch.{name}: zteleop {verb} wants a terminal of its own; start it by hand")
    if verb in VERBS:
        typed = [*typed[: len(typed) - len(rest)], *_settings(verb, rest, path), *rest]
        leash = ["--with-parent"] if verb in LEASHED else []
        return Program([sys.executable, "-m", "zteleop", *typed, *leash], verb == "actuator")
    if "/" not in verb and which(verb) is None:
        known = [one for one in VERBS if one not in NEEDS_TERMINAL]
        raise ConfigError(
            f"launch.{name}: no program {verb!r}, and no verb of zteleop; {nearest(verb, known)}"
        )
    return Program(typed)


def _expect_file(name: str, words: str) -> None:
    """Raise ConfigError where a program is named by its file, and that is not there."""
    verb, rest = find_verb(shlex.split(words))
    takes_file = verb == "run" or Path(verb).name.startswith("python")
    files = [verb] if "/" in verb else []
    files += [word for word in rest[:1] if takes_file and word.endswith(".py")]
    for file in files:
        if which(file) is None and (file == verb or not Path(file).is_file()):
            what = "no program that may be run" if file == verb else "no such file"
            raise ConfigError(f"launch.{name}: {what}, seen from {Path.cwd()}: {file}")


def teller(programs: Mapping[str, Program]) -> "Teller":
    return Teller(list(programs), sys.stdout.isatty() and wants_color(environ))


class Teller:
    """Prints what each program says behind its name."""

    def __init__(self, names: list[str], color: bool) -> None:
        self._width = max(map(len, names))
        self._colors = {name: COLORS[place % len(COLORS)] for place, name in enumerate(names)}
        self._color = color

    def __call__(self, name: str, line: str) -> None:
        head = f"{name:{self._width}} |"
        if self._color:
            head = f"\x1b[{self._colors[name]}m{head}\x1b[0m"
        print(f"{head} {printable(line)}", flush=True)


def unit(name: str, one: Program) -> str:
    """Return a systemd unit that starts a program with the machine, and again when it fails."""
    first, *rest = (word for word in one.command if word != "--with-parent")
    command = shlex.join([which(first) or first, *rest])  # systemd looks in no PATH of a shell
    return UNIT.format(
        name=name,
        command=_literal(command).replace("$", "$$"),
        place=_literal(str(Path.cwd())),
        kind=OF_A_ROBOT if one.ends_first else "",
    )


def _literal(text: str) -> str:
    """Return a text in which systemd fills in nothing."""
    return text.replace("%", "%%")


def _settings(verb: str, rest: list[str], path: Path) -> list[str]:
    """Return the option that leads a verb to the same settings, unless it names others, or reads none."""
    knows = "--config" in places_of(verb).options
    return ["--config", str(path.resolve())] if knows and "--config" not in rest else []
