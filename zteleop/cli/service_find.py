import argparse

from zteleop.bus.escape import printable
from zteleop.cli import _options
from zteleop.cli._graph import graph
from zteleop.errors import BusError, nearest
from zteleop.messages import is_called

EXAMPLES = (
    "zteleop service find rcl_interfaces/srv/GetParameters",
    "zteleop service find SetParameters --count-services",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("service_type", metavar="type", help="such as std_srvs/srv/Trigger, or Trigger")
    parser.add_argument("-c", "--count-services", action="store_true", help="say only how many")


def run(arguments: argparse.Namespace) -> None:
    wanted = arguments.service_type
    with graph(arguments) as there:
        known = there.all_services
    found = sorted({f"/{one.robot}/{one.topic}" for one in known if is_called(one.type, wanted)})
    if arguments.count_services:
        print(len(found))
    elif found:
        print(printable("\n".join(found), keep="\n"))
    else:
        types = {one.type for one in known}
        raise BusError(f"no service here is a {wanted}; {nearest(wanted, types)}")
