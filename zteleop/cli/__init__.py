"""What you type. One file per verb, one line below; what they share begins with an underscore."""

import os
import sys
from typing import NoReturn

VERBS = {
    "demo": "drive a simulated car, all in one",
    "keyboard": "drive with the keys of this terminal",
    "gamepad": "drive with a gamepad, while its dead-man is held",
    "buttons": "drive with the two buttons on a robot, while they are held",
    "drive": "drive at a speed for some time, and say how far it went",
    "circle": "drive a circle, and say how wide it was",
    "square": "drive a square, and say how far from its start it ended",
    "goto": "drive to a place, and say how near it came",
    "web": "drive from a page in a browser, and see where it goes",
    "keys": "show what your terminal sends for each key, and what that does",
    "actuator": "obey commands: turn them into pulses for servos and ESCs",
    "stop": "stop a robot until it is released",
    "sim": "move a simulated vehicle by the pulses of a simulated chip",
    "odometry": "say where a robot should be that has nothing else to say so",
    "camera": "say what a robot's camera sees, as pictures",
    "list": "list the topics of every robot on the bus",
    "echo": "print what a topic says",
    "pub": "say something on a topic",
    "hz": "say how often a topic is said",
    "bw": "say how many bytes a second a topic takes",
    "watch": "show everything that is said on the bus, as it changes",
    "delay": "say how old a topic's messages are when they arrive",
    "info": "say who publishes and who hears a topic",
    "type": "say which type of message a topic carries",
    "find": "list the topics that carry a type of message",
    "node list": "list the nodes of every robot on the bus",
    "node info": "say what a node publishes and hears",
    "graph": "show who says what to whom",
    "log": "show what the nodes of a robot log",
    "service list": "list what the nodes here answer when they are asked",
    "service type": "say which type a service has",
    "service find": "list the services of a type",
    "service call": "ask a service, and print its answer",
    "param list": "list the parameters of nodes: what can be changed while they run",
    "param get": "print a parameter of a node",
    "param set": "change a parameter of a node",
    "param describe": "say what a parameter is, and may be",
    "param dump": "print all parameters of a node, as a file for param load",
    "param load": "change a node's parameters as a file says",
    "interface list": "list the types of messages, services and actions",
    "interface show": "say what a type of message is made of",
    "interface proto": "print a message of a type, to be filled in for pub",
    "why": "say why a robot moves as it does, or does not",
    "latency": "show how long commands take from an act to the chip, part by part",
    "blackbox": "tell what happened in the minute before a robot stopped",
    "watchdog": "show what a robot's watchdog sees",
    "chaos": "do to a robot whatever can go wrong, and certify that it stops",
    "run": "run a Python program where zteleop is installed",
    "up": "start what [launch] of config.toml names, and start it again when it fails",
    "neutral": "bring a chip to rest with nothing else running",
    "doctor": "say what hinders zteleop on this machine",
    "completion": "print what lets your shell complete what you type",
    "init": "write a config file, by five questions",
    "calibrate": "find out how far a car's servo and motor turn, and write it down",
    "check": "check a config file",
    "schema": "write the JSON Schema of every message and of config.toml",
}

SECTIONS = {
    "demo": "drive",
    "actuator": "the robot",
    "list": "see and say what is on the bus",
    "why": "understand what it does",
    "run": "set up",
}
"""the verbs before which the list of them has a heading"""

GROUPS = {
    "topic": ("list", "echo", "pub", "hz", "bw", "delay", "watch", "info", "type", "find"),
    "node": ("list", "info"),
    "service": ("list", "type", "find", "call"),
    "param": ("list", "get", "set", "describe", "dump", "load"),
    "interface": ("list", "show", "proto"),
}
"""verbs that are typed behind a word, as those who know ros2 do; those of topics also without it"""
ELSEWHERE = {
    "action": "robots here have no actions: zteleop list, zteleop service list",
    "bag": "a robot keeps its last minute: zteleop blackbox",
    "lifecycle": "a node runs from its start to its end: zteleop node list; zteleop up starts what ends",
    "component": "each verb is a process of its own: zteleop up starts several",
    "daemon": "none is needed: each verb asks the bus itself",
    "multicast": "zteleop doctor looks whether others are found",
    "pkg": "there are no packages: a program is any Python file",
    "rosbag": "a robot keeps its last minute: zteleop blackbox",
    "wtf": "zteleop doctor says what hinders it here",
    "release": "zteleop stop --release lets a robot drive again",
    "launch": "zteleop up starts what [launch] of config.toml names",
}
"""what people type who come from elsewhere, and what there is instead"""

USAGE = """usage: zteleop VERB ...

Drive a small robot from any device, safely.

{verbs}

zteleop VERB --help tells more. Start with: zteleop demo
"""


def program() -> NoReturn:
    """Run one verb as a process, which ends at once: Python's own end takes 20 to 50 ms more, for nothing."""
    try:
        code = main()
        sys.stdout.flush()  # what Ctrl-C left in it
        sys.stderr.flush()
    except OSError:  # whoever read is gone
        code = 1
    os._exit(code)


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


def find_verb(words: list[str]) -> tuple[str, list[str]]:
    """Return the verb that words begin with, known or not, and what stands behind it."""
    verb, *rest = words
    if verb in GROUPS and rest:
        return _grouped_verb(verb, rest[0]), rest[1:]
    return verb, rest


def file_of(verb: str) -> str:
    """Return the name of the file that holds a verb."""
    return verb.replace(" ", "_")


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
        print(USAGE.format(verbs=_table(VERBS)), end="")
        return 0
    if arguments[0] in ("-V", "--version"):
        from importlib.metadata import version

        print(f"zteleop {version('zteleop')}")
        return 0
    if arguments[0] in GROUPS and (not arguments[1:] or arguments[1] in ("-h", "--help")):
        print(f"usage: zteleop {arguments[0]} VERB ...\n\n{_table(_grouped(arguments[0]))}")
        return 0
    verb, rest = find_verb(arguments)
    if verb not in VERBS:
        print(f"zteleop: {_unknown(verb)}", file=sys.stderr)
        return 2
    from zteleop.cli._run import run_verb

    return run_verb(verb, VERBS[verb], rest)


def _table(verbs: dict[str, str]) -> str:
    """Return a line for each verb, and where a section of all of them begins its name."""
    width = max(map(len, verbs))
    lines: list[str] = []
    for verb, text in verbs.items():
        if verb in SECTIONS and len(verbs) == len(VERBS):
            lines += [*([""] if lines else []), f"{SECTIONS[verb]}:"]
        lines.append(f"  {verb:{width}}  {text}")
    return "\n".join(lines)


def _grouped_verb(group: str, word: str) -> str:
    """Return the verb that a word behind a group's name is; those of topics need no group."""
    flat = group == "topic" and word in GROUPS[group]
    return word if flat else f"{group} {word}"


def _grouped(group: str) -> dict[str, str]:
    return {f"{group} {word}": VERBS[_grouped_verb(group, word)] for word in GROUPS[group]}


def _unknown(verb: str) -> str:
    from difflib import get_close_matches

    if verb.endswith(".py"):
        return f"no verb {verb!r}; zteleop run {verb} runs a program"
    if verb in ELSEWHERE:
        return f"no verb {verb!r}; {ELSEWHERE[verb]}"
    if verb.startswith("-"):
        near = get_close_matches(verb, ["--help", "--version"], 1)
        behind = "options stand behind the verb, as in zteleop why --robot archangel"
        return f"no verb {verb!r}; " + (f"did you mean {near[0]}?" if near else behind)
    group, _, word = verb.partition(" ")
    if group in GROUPS:
        near = get_close_matches(word, GROUPS[group], 1)
        there = f"did you mean {group} {near[0]}?" if near else f"there are {', '.join(_grouped(group))}"
        return f"no verb {verb!r}; {there}"
    near = get_close_matches(verb, [*VERBS, *GROUPS], 1)
    return f"no verb {verb!r}; " + (f"did you mean {near[0]}?" if near else f"known: {', '.join(VERBS)}")
