"""What you type. One file per verb, one line below; what they share begins with an underscore."""

import os
import sys

VERBS = {
    "demo": "drive a simulated car, all in one",
    "keyboard": "drive with the keys of this terminal",
    "actuator": "obey commands: turn them into pulses for servos and ESCs",
    "stop": "stop a robot until it is released",
    "sim": "move a simulated vehicle by the pulses of a simulated chip",
    "list": "list the topics of every robot on the bus",
    "echo": "print what a topic says",
    "pub": "say something on a topic",
    "why": "say why a robot moves as it does, or does not",
    "blackbox": "tell what happened in the minute before a robot stopped",
    "watchdog": "show what a robot's watchdog sees",
    "chaos": "do to a robot whatever can go wrong, and certify that it stops",
    "neutral": "bring a chip to rest with nothing else running",
    "doctor": "say what hinders zteleop on this machine",
    "check": "check a config file",
    "schema": "write the JSON Schema of every message and of config.toml",
}

GROUPS = {"topic": ("list", "echo", "pub")}
"""verbs that may be typed behind a word, as those who know ros2 do"""
ELSEWHERE = {
    "node": "zteleop list -v shows which nodes publish and hear",
    "run": "a program runs by its own name; zteleop keyboard drives",
    "topic": "zteleop list, echo and pub are about topics",
}
"""what people type who come from elsewhere, and what there is instead"""

USAGE = """usage: zteleop VERB ...

Drive a small robot from any device, safely.

{verbs}

zteleop VERB --help tells more. Start with: zteleop demo
"""


def main(argv: list[str] | None = None) -> int:
    """Run one verb; return 0 done, 1 error, 2 usage, 130 Ctrl-C, 143 SIGTERM."""
    _open_standard_files()
    try:
        code = _dispatch(sys.argv[1:] if argv is None else argv)
        sys.stdout.flush()
        return code
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:  # whoever read is gone: what is left to say goes nowhere, quietly
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1


def _open_standard_files() -> None:
    """Open /dev/null in the place of a standard file that is closed.

    Else the next file that is opened takes its number, be it a chip or a lock, and log lines go into it.
    """
    while (file := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(file, True)
    os.close(file)
    for file, (name, mode) in enumerate((("stdin", "r"), ("stdout", "w"), ("stderr", "w"))):
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(file, mode, closefd=False))


def _dispatch(arguments: list[str]) -> int:
    if not arguments or arguments[0] in ("-h", "--help"):
        print(USAGE.format(verbs="\n".join(f"  {verb:10} {text}" for verb, text in VERBS.items())), end="")
        return 0
    if arguments[0] in ("-V", "--version"):
        from importlib.metadata import version

        print(f"zteleop {version('zteleop')}")
        return 0
    if arguments[1:] and arguments[1] in GROUPS.get(arguments[0], ()):
        arguments = arguments[1:]
    if arguments[0] in GROUPS and arguments[1:]:
        arguments = [f"{arguments[0]} {arguments[1]}"]
    if arguments[0] not in VERBS:
        print(f"zteleop: {_unknown(arguments[0])}", file=sys.stderr)
        return 2
    from zteleop.cli._run import run_verb

    return run_verb(arguments[0], VERBS[arguments[0]], arguments[1:])


def _unknown(verb: str) -> str:
    from difflib import get_close_matches

    if verb in ELSEWHERE:
        return f"no verb {verb!r}; {ELSEWHERE[verb]}"
    if verb.partition(" ")[0] in GROUPS:
        group = verb.partition(" ")[0]
        return f"no verb {verb!r}; there are {', '.join(f'{group} {one}' for one in GROUPS[group])}"
    near = get_close_matches(verb, VERBS, 1)
    return f"no verb {verb!r}; " + (f"did you mean {near[0]}?" if near else f"known: {', '.join(VERBS)}")
