import argparse
from typing import Any

import msgspec

from zteleop.bus import clock
from zteleop.bus.names import resolve
from zteleop.bus.node import Node
from zteleop.bus.publisher import Publisher
from zteleop.bus.topics import topic_of
from zteleop.cli import options
from zteleop.control.stick import neutral_pwm
from zteleop.errors import BusError, MessageError
from zteleop.interfaces.values import fill
from zteleop.messages import Int16MultiArray, Message, Pwm, Vehicle, message_type

PATIENCE = 3.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    options.add(parser)
    parser.add_argument("topic", help="such as archangel/cmd_vel")
    parser.add_argument("type", help="such as geometry_msgs/msg/Twist, or Twist")
    parser.add_argument("values", nargs="?", default="{}", help="YAML: '{linear: {x: 0.2}}'; the rest is 0")
    parser.add_argument("-r", "--rate", metavar="HZ", type=_positive, default=1.0, help="default: 1")
    parser.add_argument("-1", "--once", action="store_true", help="say it once and end")
    parser.add_argument("-t", "--times", metavar="N", type=_count, help="say it N times and end")


def run(arguments: argparse.Namespace) -> None:
    settings = options.load(arguments)
    kind = message_type(arguments.type)
    message = fill(kind, _yaml(arguments.values))
    times = 1 if arguments.once else arguments.times
    robot = options.robot_of(arguments.topic, settings)
    with options.join("pub", msgspec.structs.replace(settings, robot=robot)) as node:
        name = resolve(arguments.topic, node.robot)
        publisher = node.publisher(f"/{name.robot}/{name.path}", kind)
        _wait(node, publisher, topic_of(name.path).command)
        _say(node, publisher, message, arguments.rate, times)


def _say(node: Node, publisher: Publisher[Message], message: Message, rate: float, times: int | None) -> None:
    """Say a message again and again; a repeated motion ends with a neutral."""
    said = 0

    @node.every(1 / rate)
    def say() -> None:
        nonlocal said
        said += 1
        print(f"publishing #{said}: {message}\n", flush=True)
        publisher.publish(message)
        if said == times:
            node.stop()

    try:
        node.spin()
    finally:
        rest = _rest(message, node.heard().vehicle) if times is None and publisher.sender else None
        if rest:
            publisher.publish(rest)


def _rest(message: Message, vehicle: Vehicle | None) -> Message | None:
    """Return the neutral command of the same type, if there is one; of pulses, 0 is none."""
    if not isinstance(message, Pwm | Int16MultiArray):
        return type(message).zero()
    if vehicle is None or vehicle.kind != "ackermann":
        return None
    pwm = neutral_pwm(vehicle)
    neutral = [pwm.steering_ticks, pwm.throttle_ticks]
    return pwm if isinstance(message, Pwm) else Int16MultiArray(message.layout, neutral)


def _wait(node: Node, publisher: Publisher[Message], command: bool) -> None:
    """Wait until somebody hears; a command also needs a beat of the robot to prove that it is new."""
    give_up = clock.now() + PATIENCE
    while clock.now() < give_up:
        heard = node.heard()
        heard.listen()
        if publisher.heard and (heard.beat or not command):
            return
        node.spin(0.005)
    if command:
        raise BusError(f"robot {node.robot} does not answer; is its actuator on? zteleop list shows who is")
    print("nobody hears this yet", flush=True)


def _yaml(text: str) -> Any:
    import yaml

    try:
        return yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        problem = " ".join(str(error).split())
        raise MessageError(
            f"expected YAML such as '{{linear: {{x: 0.2}}}}', found {text!r}: {problem}"
        ) from None


def _count(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"say it at least once, found {text}")
    return int(text)


def _positive(text: str) -> float:
    value = float(text)
    if not 0 < value <= 1000:
        raise argparse.ArgumentTypeError(f"a rate is more than 0 and at most 1000 Hz, found {text}")
    return value
