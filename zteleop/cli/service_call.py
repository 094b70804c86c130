import argparse
import sys
import time

from zteleop.bus.escape import printable
from zteleop.bus.names import Name
from zteleop.bus.service import ANSWERED_WITHIN, call
from zteleop.bus.session import Session, open_session
from zteleop.cli import _options
from zteleop.cli._draft import Draft
from zteleop.cli._graph import look
from zteleop.errors import BusError
from zteleop.messages import service_type
from zteleop.text.ros_repr import ros_repr

EXAMPLES = (
    "zteleop service call archangel/actuator/list_parameters ListParameters",
    "zteleop service call archangel/actuator/get_parameters GetParameters '{names: [log_level]}'",
)
THERE_WITHIN = 3.0
"""s to wait for somebody who serves it"""
TELL_AFTER = 1.0
"""s of that until it says for whom it waits"""
GLANCE = 0.1


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("service", help="such as archangel/lights, or lights with --robot")
    parser.add_argument("service_type", metavar="type", help="such as std_srvs/srv/SetBool, or SetBool")
    parser.add_argument("values", nargs="?", default="{}", help="YAML: '{data: true}'; the rest is 0")
    parser.add_argument("-r", "--rate", metavar="HZ", type=_options.rate_hz, help="ask again and again")
    parser.add_argument(
        "--timeout", metavar="TIME", type=_options.seconds, default=ANSWERED_WITHIN, help="for an answer (2s)"
    )


def run(arguments: argparse.Namespace) -> None:
    settings = _options.load(arguments)
    request_type, response_type = service_type(arguments.service_type)
    draft = Draft(request_type, arguments.values)
    with open_session(settings.bus, settle=True) as session:
        name = _await_server(session, arguments.service, settings.robot)
        while True:
            request = draft.make()
            print(f"requester: making request: {printable(ros_repr(request))}\n", flush=True)
            response = call(session, name, request, response_type, arguments.timeout)
            print(f"response:\n{printable(ros_repr(response))}\n", flush=True)
            if arguments.rate is None:
                return
            time.sleep(1 / arguments.rate)


def _await_server(session: Session, text: str, robot: str | None) -> Name:
    """Wait until somebody serves what is meant; raises BusError when nobody comes."""
    start, told = time.monotonic(), False
    while True:
        try:
            return look(session, robot).service(text)[0]
        except BusError as error:
            waited = time.monotonic() - start
            if waited > THERE_WITHIN:
                raise
            if waited > TELL_AFTER and not told:
                words = f"waits for somebody who serves {text}: {error}"
                print(printable(f"zteleop service call: {words}"), file=sys.stderr, flush=True)
                told = True
            time.sleep(GLANCE)
