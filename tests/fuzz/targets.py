"""Everything of zteleop that takes bytes which a stranger, or a broken disk, may have written.

Each target takes any bytes at all: it returns, having checked what must hold, or it has found a fault.
"""

from collections.abc import Callable

from fuzz import bus_targets as bus
from fuzz import operator_targets as operator
from fuzz import robot_targets as robot

TARGETS: dict[str, Callable[[bytes], None]] = {
    "arguments": operator.arguments,
    "blackbox": robot.blackbox,
    "chip": robot.chip_file,
    "config": robot.config_text,
    "endpoint": bus.endpoint,
    "journal": robot.journal,
    "kept": robot.kept,
    "keyboard": operator.keyboard,
    "keymap": operator.keymap,
    "keys": operator.keys,
    "link-actuator": robot.link_of_actuator,
    "link-watchdog": robot.link_of_watchdog,
    "message": bus.message,
    "names": bus.names,
    "orders": robot.orders,
    "proof": bus.proof,
    "robot-file": robot.robot_file,
    "screen": bus.screen,
    "stop-file": robot.stop_file,
    "token": bus.token,
    "values": operator.values,
}
