"""How a command that somebody is typing may go on; the last word is the one that is not whole yet."""

import argparse
import io
from collections.abc import Callable, Iterable
from contextlib import redirect_stderr, suppress
from importlib import import_module
from typing import Any, NamedTuple, Self

from zteleop.bus.escape import printable
from zteleop.cli import GROUPS, VERBS, file_of, find_verb

OPTIONS_OF_ALL = ("--help", "--debug")


def candidates(words: list[str]) -> list[str]:
    """Return what the last word may be, sorted; nothing where nobody knows, such as for a file."""
    *before, last = words
    if not before:
        found: Iterable[str] = {verb.partition(" ")[0] for verb in VERBS} | GROUPS.keys()
    elif len(before) == 1 and before[0] in GROUPS:
        found = GROUPS[before[0]]
    else:
        found = _after_verb(before, last)
    return sorted(word for word in {*found} if word.startswith(last) and word == printable(word))


class Place(NamedTuple):
    """Where a word may stand: an option, or its value, or a word by itself."""

    names: tuple[str, ...]
    dest: str
    choices: tuple[str, ...]
    takes_value: bool
    repeats: bool


class Places:
    """Stands in a parser's place while a verb adds its arguments, and keeps where words may stand."""

    epilog = ""

    def __init__(self) -> None:
        self.options: dict[str, Place] = {}
        self.words: list[Place] = []

    def add_argument(self, *names: str, **about: Any) -> None:
        """Take in an argument as argparse does."""
        place = Place(
            names,
            about.get("dest") or names[-1].lstrip("-"),
            tuple(map(str, about.get("choices") or ())),
            about.get("action", "append") == "append",
            about.get("nargs") in ("*", "+"),
        )
        if names[0].startswith("-"):
            self.options.update(dict.fromkeys(names, place))
        else:
            self.words.append(place)

    def add_argument_group(self, title: str) -> Self:
        """Return itself: groups are for people."""
        return self

    def at(self, typed: list[str]) -> Place | None:
        """Return what the word behind others stands for, by what and how many they are."""
        given, value_of = 0, False
        for word in typed:
            given += not (value_of or word.startswith("-"))
            value_of = word in self.options and self.options[word].takes_value
        if value_of:
            return self.options[typed[-1]]
        if given < len(self.words):
            return self.words[given]
        return self.words[-1] if self.words and self.words[-1].repeats else None


def places_of(verb: str) -> Places:
    """Return where words may stand behind a verb that there is."""
    places = Places()
    import_module(f"zteleop.cli.{file_of(verb)}").add_arguments(places)
    return places


def _after_verb(before: list[str], last: str) -> Iterable[str]:
    verb, typed = find_verb(before)
    if verb not in VERBS:
        return ()
    places = places_of(verb)
    if last.startswith("-"):
        return (*OPTIONS_OF_ALL, *(name for name in places.options if name.startswith("--")))
    place = places.at(typed)
    return _values(place, typed, last) if place else ()


def _values(place: Place, typed: list[str], last: str) -> Iterable[str]:
    """Return what may stand in one place of a verb."""
    if place.choices:
        return place.choices
    if place.dest in ("topic", "topics"):
        return _on_the_bus(typed, lambda graph: _topics(graph, last))
    if place.dest in ("robot", "named"):
        return _on_the_bus(typed, lambda graph: {node.robot for node in graph.nodes})
    if place.dest == "service":
        return _on_the_bus(
            typed, lambda graph: _begun(last, [(one.robot, one.topic) for one in graph.all_services])
        )
    if place.dest == "parameter":
        return _parameters(typed)
    if place.dest == "node":
        return _on_the_bus(typed, lambda graph: _begun(last, [(one.robot, one.node) for one in graph.nodes]))
    if place.dest == "field":
        return _on_the_bus(typed, lambda graph: _fields(graph, _known(typed)[1], last))
    known = _types(place.dest)
    if place.dest == "type" and not any(name.startswith(last) for name in known):
        return _on_the_bus(typed, lambda graph: {one.type for one in graph.endpoints})
    return known


def _topics(graph: Any, last: str) -> Iterable[str]:
    """Return topics in the form that was begun: with a slash, with a robot, or of the robot that is meant."""
    names: list[str] = [*graph.topics()]
    if last.startswith("/"):
        return names
    with_robot = [name.removeprefix("/") for name in names]
    own = f"{graph.robot}/"
    plain = [name.removeprefix(own) for name in with_robot if name.startswith(own)]
    return with_robot if not last or any(name.startswith(last) for name in with_robot) else plain


def _fields(graph: Any, words: list[str], last: str) -> Iterable[str]:
    """Return the fields of a topic's type where they were begun: `pose.po`; of a type that all know."""
    from zteleop.cli._graph import types_of
    from zteleop.interfaces.declared import message_in
    from zteleop.messages import MESSAGES
    from zteleop.messages.message import field_types

    kind = MESSAGES.get(types_of(graph.topic(words[0])[1])[0]) if words else None
    before, _, _ = last.rpartition(".")
    for part in before.split(".") if before else ():
        held = field_types(kind).get(part) if kind else None
        kind = message_in(held, "") if held is not None else None
    return [f"{before}.{name}" if before else name for name in field_types(kind)] if kind else ()


def _begun(last: str, names: Iterable[tuple[str, str]]) -> Iterable[str]:
    """Return nodes or services in the form that was begun: with a slash, by their names, or with robots."""
    forms = ("/{0[0]}/{0[1]}",) if last.startswith("/") else ("{0[1]}", "{0[0]}/{0[1]}")
    found = [[form.format(name) for name in names] for form in forms]
    return next((names for names in found if any(name.startswith(last) for name in names)), ())


def _types(dest: str) -> Iterable[str]:
    if dest == "type":
        from zteleop.messages import MESSAGES
        from zteleop.messages.service import is_half

        return [name for name in MESSAGES if not is_half(name)]
    if dest == "service_type":
        from zteleop.messages import SERVICES

        return SERVICES
    return ()


def _parameters(typed: list[str]) -> Iterable[str]:
    """Return the parameters of the node that stands before."""
    from zteleop.cli._params import parameters_of
    from zteleop.errors import ZteleopError

    arguments, words = _known(typed)
    if words:
        arguments.node = words[0]
        with suppress(ZteleopError), parameters_of(arguments) as node:
            return node.names()
    return ()


def _on_the_bus(typed: list[str], pick: Callable[[Any], Iterable[str]]) -> Iterable[str]:
    """Return something of everybody who is there, by what was typed of where the bus is."""
    from zteleop.cli._graph import graph
    from zteleop.errors import ZteleopError

    with suppress(ZteleopError), graph(_known(typed)[0]) as found:
        return pick(found)
    return ()


def _known(typed: list[str]) -> tuple[argparse.Namespace, list[str]]:
    """Return what was typed of where the bus is, and the other words."""
    from zteleop.cli import _options

    parser = argparse.ArgumentParser(add_help=False, exit_on_error=False)
    _options.add(parser)
    arguments, words = parser.parse_args([]), typed
    with suppress(argparse.ArgumentError, SystemExit), redirect_stderr(io.StringIO()):
        arguments, words = parser.parse_known_args(typed)
    return arguments, [word for word in words if not word.startswith("-")]
