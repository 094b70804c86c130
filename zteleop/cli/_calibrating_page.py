"""The questions of `zteleop calibrate` on a page: whoever watches the wheels has a phone in the hand."""

import sys
from collections.abc import Callable
from importlib.metadata import version
from typing import TYPE_CHECKING

from zteleop.bus.lane.call import Call
from zteleop.bus.node import Node
from zteleop.cli import _pages
from zteleop.cli._calibrating import Seat, seen_by
from zteleop.cli._driving import find_vehicle
from zteleop.config import Config
from zteleop.control.measuring import Measuring
from zteleop.errors import ZteleopError
from zteleop.inputs.tuner import BACKWARD, Tuner
from zteleop.nodes.teleop import Teleop
from zteleop.screen.view import View

if TYPE_CHECKING:
    from zteleop.bridges.web.questions import Questions

SOURCE = "web"
SHOWN_WITHIN = 3.0
"""s that a page has to show the last word"""
Measure = Callable[[Seat], tuple[int, list[str]]]
"""finds out, keeps it, and returns an exit code and what to tell"""


def on_a_page(
    settings: Config, robot: str, place: _pages.Place, does: str, about: tuple[str, str], measure: Measure
) -> int:
    """Ask on pages; return the exit code. What goes wrong is told there as well."""
    from zteleop.bridges.web.questions import Questions

    questions = Questions(robot, version("zteleop"))
    do, begins = about

    def tell(words: str) -> None:
        print(f"zteleop calibrate: {words}", file=sys.stderr, flush=True)

    with _pages.served(questions, place, f"calibrates {robot}", tell, "calibrate.html"):
        questions.await_begin([does, do], begins)
        try:
            code, lines = measure(Seat(SOURCE, lambda node, part: sit(node, part, settings, questions)))
        except ZteleopError as error:
            questions.end([str(error)], SHOWN_WITHIN)
            raise
        print("\n".join(lines))
        questions.end(lines, SHOWN_WITHIN)
    return code


def sit(node: Node, measuring: Measuring, settings: Config, questions: "Questions") -> Tuner:
    """Let pages answer one part of the questions."""
    from zteleop.bridges.web.pressed import Pressed
    from zteleop.bridges.web.questions import Sitting
    from zteleop.bridges.web.words import Asks

    keys = Pressed()
    tuner = Tuner(keys, measuring)
    see = seen_by(tuner)
    heard = node.membership.heard()

    def show(view: View) -> None:
        see(view)
        step, status = measuring.step, view.status
        questions.tell(
            Asks(
                step=min(measuring.number + 1, len(measuring.steps)),
                steps=len(measuring.steps),
                axis=step.axis,
                asks=step.asks,
                brakes=step.find in BACKWARD,
                found=[f"{name}: {value}" for name, value in tuner.found],
                state=status.state if status else "not heard",
                why=view.refused or (status.why if status else "the robot is not heard"),
                note=tuner.in_vain or view.note,
                out={pulse.name: pulse.duty_ticks for pulse in status.pulses} if status else {},
                idle_left=tuner.idle_left(view.now),
                beat=heard.beat.time if heard.beat else 0.0,
            )
        )

    with tuner, Call(settings.bus) as lane:
        teleop = Teleop(node, tuner, SOURCE, find_vehicle(node, settings), show, lane)

        def press(key: str) -> None:
            keys.press(key)
            teleop.obey()

        questions.sit(Sitting(node, press))
        try:
            teleop.run()
        finally:
            questions.sit(None)
    return tuner
