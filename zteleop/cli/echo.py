import argparse
import sys
from typing import TYPE_CHECKING

from zteleop.bus import clock, codec
from zteleop.bus.escape import printable
from zteleop.bus.names import Name
from zteleop.bus.session import Sample
from zteleop.bus.topics import topic_of
from zteleop.cli import _options
from zteleop.cli._listening import TELL_AFTER, Arrival, Complaints, listening
from zteleop.errors import BusError, MessageError
from zteleop.messages import MESSAGES
from zteleop.text import paths
from zteleop.text.form import Form
from zteleop.text.rendering import CUT, Style
from zteleop.text.selection import Selection

if TYPE_CHECKING:
    from zteleop.text.filter import Filter

EXAMPLES = (
    "zteleop echo odom",
    "zteleop echo archangel/drive_status --once",
    "zteleop echo drive_status --field state --field why --count 3",
    "zteleop echo drive_status --since 10s --count 1",
    "zteleop echo odom --csv --header --filter 'm.twist.twist.linear.x >= 0' --count 3",
)
CLEAR = "\x1b[H\x1b[2J"
TELL_AGAIN = 10.0
"""s until it says once more that nothing is what was asked for"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("topic", help="such as archangel/odom, or odom with --robot")
    parser.add_argument("type", nargs="?", help="show only messages of that type, such as Twist")
    shown = parser.add_argument_group("what of it")
    shown.add_argument(
        "--field", metavar="PATH", action="append", help="such as twist.linear.x; may be repeated"
    )
    shown.add_argument(
        "--filter", metavar="EXPR", help="messages of which it is true: 'm.twist.linear.x > 0.2'"
    )
    shown.add_argument("--once", action="store_true", help="print one message and end")
    shown.add_argument("-n", "--count", metavar="N", type=_options.count, help="print N messages and end")
    shown.add_argument(
        "--timeout", metavar="TIME", type=_options.seconds, help="give up after so long a silence: 5, 500ms"
    )
    since = "begin with what was said in the last 10s, as the robot's black box kept it; at most 60s"
    shown.add_argument("--since", metavar="TIME", type=_options.seconds, help=since)
    form = parser.add_argument_group("how it looks")
    form.add_argument("--json", action="store_true", help="one message a line, as JSON")
    form.add_argument("-p", "--csv", action="store_true", help="one message a row, its values in columns")
    form.add_argument("--header", action="store_true", help="with --csv: first a row of the names")
    form.add_argument("--raw", action="store_true", help="its bytes, as they came")
    form.add_argument("--flow-style", action="store_true", help="YAML in one line")
    form.add_argument("--no-arr", action="store_true", help="of arrays only their type")
    form.add_argument("--no-str", action="store_true", help="of texts only their length")
    form.add_argument("-f", "--full-length", action="store_true", help="cut nothing short")
    cut = f"cut arrays and texts to N ({CUT})"
    form.add_argument("--truncate-length", metavar="N", type=_options.count, default=CUT, help=cut)
    form.add_argument("-c", "--clear", action="store_true", help="clear the screen before each message")


def run(arguments: argparse.Namespace) -> None:
    wanted = Wanted(arguments)
    wait, left = arguments.timeout, 1 if arguments.once else arguments.count
    came = shown = 0
    with listening("echo", [arguments.topic], arguments, settle=arguments.since is not None) as (
        ears,
        (name,),
    ):
        wanted.check(name)
        ears.patient = wait is None or wait > TELL_AFTER

        def give_up() -> None:
            if came > shown:
                raise BusError(f"for {wait:g} s none of what came on {name} was what was asked for")
            silent = name if ears.told and not came else ears.why_silent(name)
            raise BusError(f"for {wait:g} s nothing was said on {silent}")

        def tell() -> None:
            if came and not shown:
                words = f"{came} messages came on {name} so far, and none is what was asked for"
                print(printable(f"zteleop echo: {words}"), file=sys.stderr, flush=True)
            if not shown:
                telling.ring_at(clock.now() + TELL_AGAIN)

        silence = ears.loop.alarm(give_up)

        def show(arrival: Arrival) -> None:
            nonlocal left, came, shown
            came += 1
            if not wanted.show(arrival.sample):
                return
            shown += 1
            if wait is not None:
                silence.ring_at(arrival.at + wait)
            if left is None:
                return
            left -= 1
            if not left:
                ears.loop.stop()

        ears.hear(name, show, arguments.since)
        wanted.prepare()  # while the first message is on its way
        if wait is not None:
            silence.ring_at(clock.now() + wait)
        telling = ears.loop.alarm(tell)
        telling.ring_at(clock.now() + TELL_AFTER)
        ears.run()


class Wanted:
    """What somebody wants to see of a topic, and how; raises MessageError for words that make no sense."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        self._raw = arguments.raw
        self._before = CLEAR if arguments.clear and sys.stdout.isatty() else ""
        style = Style(
            None if arguments.full_length else arguments.truncate_length,
            arguments.no_arr,
            arguments.no_str,
            arguments.flow_style,
        )
        self._form = Form(
            "json" if arguments.json else "csv" if arguments.csv else "yaml", style, arguments.header
        )
        self._selection = Selection(
            arguments.type, tuple(map(paths.parse, arguments.field or ())), _filter(arguments.filter)
        )
        self.complaints = Complaints()
        self._known: dict[str, bool] = {}
        """whether the messages of a type have what is asked for"""

    def check(self, name: Name) -> None:
        """Raise MessageError where no message of the topic can have what is asked for."""
        self._selection.check_types(topic_of(name.path).types, str(name))

    def prepare(self) -> None:
        """Load what it takes to print a message."""
        if not self._raw:
            self._form.prepare()

    def show(self, sample: Sample) -> bool:
        """Print a message that is wanted; False for any other, and one that cannot be read is told of."""
        try:
            text = self.text(sample)
        except MessageError as error:
            words = str(error)
            about = words if words.startswith(sample.key) else f"{sample.key}: {words}"
            self.complaints.tell(f"zteleop echo: {about}")
            return False
        if text is None:
            return False
        print(f"{self._before}{text}", flush=True)
        return True

    def text(self, sample: Sample) -> str | None:
        """Return what is shown of a message, safe to print; raises MessageError when it cannot be read."""
        if self._raw:
            return f"{sample.payload!r}\n---"
        values = codec.decode_any(sample.payload, sample.encoding)
        ros_type = sample.encoding.partition(";")[2]
        try:
            if not self._suits(values, ros_type, sample.key) or not self._selection.wants(values):
                return None
            return printable(self._form.text(self._selection.parts(values), ros_type), keep="\n")
        except RecursionError:  # read as JSON it may be, but YAML is written with a deeper stack
            size = len(sample.payload)
            raise MessageError(f"{size} bytes of {sample.encoding!r}, nested too deeply to show") from None

    def _suits(self, values: object, ros_type: str, key: str) -> bool:
        """Say whether messages of a type have what is asked for; of one that has not, it is said once."""
        if ros_type not in self._known:
            if len(self._known) > len(MESSAGES):  # whoever sends has thought of so many
                self._known.clear()
            self._known[ros_type] = False
            self._selection.check(values, ros_type, key)
            self._known[ros_type] = True
        return self._known[ros_type]


def _filter(text: str | None) -> "Filter | None":
    if text is None:
        return None
    from zteleop.text.filter import Filter  # which only few ask for

    return Filter(text)
