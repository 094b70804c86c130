import argparse
import sys

import msgspec

from zteleop import chaos, config
from zteleop.chaos.bench import Subject
from zteleop.chaos.certificate import HEAD, Verdict, certify, verdict
from zteleop.chaos.fault import Fault
from zteleop.chaos.trial import Outcome, attempt
from zteleop.chaos.waiting import await_quiet
from zteleop.cli import _options
from zteleop.cli._consent import ask_consent
from zteleop.cli.neutral import bring_to_rest
from zteleop.config import Config
from zteleop.errors import ConfigError, ZteleopError
from zteleop.machine.stop_file import StopFile

EXAMPLES = (
    "zteleop chaos --list",
    'zteleop chaos --only "at three places" --times 1',
)
LATER = 0.007
"""s by which each trial strikes later than the one before: at another moment of every period"""
TRIES = 3
"""of one trial, while what is found is the machine's lateness and not the robot's"""
QUIET_WITHIN = 10.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add_config(parser)
    parser.add_argument(
        "--times", metavar="N", type=_options.count, default=3, help="each fault (default: 3)"
    )
    parser.add_argument("--only", metavar="TEXT", default="", help="the faults whose kind or name holds this")
    parser.add_argument("--list", action="store_true", help="say what would be done, and do nothing")
    parser.add_argument("--json", action="store_true", help="print the certificate as JSON")
    parser.add_argument("--real", action="store_true", help="on the config file's chip, with its wheels up")


def run(arguments: argparse.Namespace) -> int:
    """Do every fault to a robot; 0 when each kept its bound, every time."""
    faults = [(kind, fault) for kind, fault in chaos.faults() if arguments.only in f"{kind}: {fault.name}"]
    if not faults:
        raise ConfigError(f"no fault is called {arguments.only!r}; zteleop chaos --list shows them")
    if arguments.list:
        for kind, words in chaos.KINDS.items():
            names = [f"  {fault.name}" for its_kind, fault in faults if its_kind == kind]
            print("\n".join([f"{kind}: {words}", *names]) if names else "", end="\n" if names else "")
        return 0
    left_out = [fault.name for _, fault in faults if fault.simulated and arguments.real]
    faults = [(kind, fault) for kind, fault in faults if fault.name not in left_out]
    if not faults:
        raise ConfigError(f"each of them needs a simulated chip: {', '.join(left_out)}; leave out --real")
    subject = _subject(arguments)
    try:
        verdicts = _judge(subject, faults, arguments)
    finally:
        if arguments.real:
            bring_to_rest(subject.settings, subject.settings.driver, "")
    certificate = certify(_name(subject.settings), verdicts, left_out)
    print(msgspec.json.encode(certificate).decode() if arguments.json else certificate.summary())
    return 0 if certificate.kept else 1


def _judge(subject: Subject, faults: list[tuple[str, Fault]], arguments: argparse.Namespace) -> list[Verdict]:
    verdicts = []
    _print(HEAD, arguments)
    for kind, fault in faults:
        verdicts.append(verdict(kind, fault, _try(subject, fault, arguments.times)))
        _print(verdicts[-1].line(), arguments)
    return verdicts


def _print(line: str, arguments: argparse.Namespace) -> None:
    if not arguments.json:
        print(line, flush=True)


def _name(settings: Config) -> str:
    chip = "a simulated chip" if settings.driver == "simulated" else f"the {settings.driver}"
    return f"{type(settings.drive.mixer).__name__.lower()} vehicle on {chip}"


def _subject(arguments: argparse.Namespace) -> Subject:
    """Return the robot meant, with consent where it is a real one."""
    file = arguments.config or config.found()
    settings = config.load(file)
    where = ("--config", str(file.resolve())) if file else ()
    if arguments.real:
        if settings.driver == "simulated":
            raise ConfigError("--real needs a real chip, and the simulated one is configured; set driver")
        _heed_stop(settings.robot or config.own_name())
        words = (
            f"This turns the wheels on the {settings.driver}, again and again, and kills what drives them."
        )
        ask_consent(words)
        return Subject(settings, where)
    settings = msgspec.structs.replace(settings, driver="simulated")
    chip = settings.drivers.get("simulated", {}).get("path", "")
    return Subject(settings, (*where, "--driver", "simulated"), chip=chip)


def _heed_stop(robot: str) -> None:
    """Let no chip move whose robot is stopped, though chaos drives it under another name."""
    if StopFile(config.state_folder(robot) / "stop", print).exists():
        raise ConfigError(f"{robot} is stopped; zteleop stop --release {robot} first")


def _try(subject: Subject, fault: Fault, times: int) -> list[Outcome]:
    """Do a fault so many times; a robot that cannot even be started is a broken one."""
    outcomes = []
    for number in range(times):
        if sys.stderr.isatty():
            print(f"\r{fault.name}: {number + 1} of {times} ", end="\r", file=sys.stderr, flush=True)
        outcomes += _try_once(subject, fault, number % 10 * LATER)
    return outcomes


def _try_once(subject: Subject, fault: Fault, moment: float) -> list[Outcome]:
    """Do a fault, and again where the machine was too busy to judge it by; return all that was found."""
    outcomes: list[Outcome] = []
    while len(outcomes) < TRIES:
        try:
            outcomes.append(attempt(subject, fault, moment))
        except (ZteleopError, OSError) as error:
            outcomes.append(Outcome(None, str(error)))
        if outcomes[-1].broken or outcomes[-1].verdict(fault.bound) != "not judged":
            break
        await_quiet(QUIET_WITHIN)
    return outcomes
