"""What `zteleop doctor` looks at, one line a check."""

from collections.abc import Callable

from zteleop.cli import _checkup_bus as bus
from zteleop.cli import _checkup_machine as machine
from zteleop.cli._patient import Finding, Patient

CHECKS: dict[str, Callable[[Patient], Finding]] = {
    "python": machine.python,
    "packages": machine.packages,
    "config": machine.config_file,
    "i2c": machine.i2c,
    "privileges": machine.privileges,
    "terminal": machine.terminal,
    "clock": machine.clock,
    "supply": machine.supply,
    "processes": machine.processes,
    "port": bus.port,
    "multicast": bus.multicast,
    "robots": bus.robots,
    "clocks": bus.clocks,
}
