"""A pack of cells: what it still holds, and how its voltage gives way to a current."""

from bisect import bisect
from math import sqrt
from typing import Annotated

from msgspec import Meta, Struct

from zteleop.messages import BatteryState, Header

Positive = Annotated[float, Meta(gt=0, le=1000)]
CHARGING, DISCHARGING, NOT_CHARGING, FULL = 1, 2, 3, 4
GOOD, LITHIUM_ION, LITHIUM_POLYMER = 1, 2, 3
ROOM = 20.0
"""degrees Celsius"""
CHARGES = (0.0, 0.05, 0.2, 0.5, 0.8, 1.0)
LEVELS = (0.0, 0.35, 0.5, 0.62, 0.8, 1.0)
"""Where a lithium cell stands between its empty and its full voltage, at those charges."""


class BatterySettings(Struct, frozen=True, forbid_unknown_fields=True):
    """A pack; as it stands a car's two lithium polymer cells."""

    cells: Annotated[int, Meta(ge=1, le=100)] = 2
    energy_wh: Positive = 37.0
    """Wh when it is full"""
    nominal_voltage: Positive = 7.4
    empty_voltage: Positive = 6.0
    """V without a load, as is the next"""
    full_voltage: Positive = 8.4
    resistance: Positive = 0.04
    """ohm inside the pack"""
    percentage: Annotated[float, Meta(ge=0, le=1)] = 1.0
    """0 to 1, at the start"""
    technology: Annotated[int, Meta(ge=0, le=255)] = LITHIUM_POLYMER
    """as sensor_msgs/msg/BatteryState numbers them"""

    def __post_init__(self) -> None:
        if self.empty_voltage >= self.full_voltage:
            raise ValueError(
                "empty_voltage must lie below full_voltage, "
                f"found {self.empty_voltage:g} and {self.full_voltage:g}"
            )

    @property
    def capacity(self) -> float:
        """Ah"""
        return self.energy_wh / self.nominal_voltage


class Battery:
    """Call `draw` or `charge` once a step, with all that goes out or comes in."""

    def __init__(self, settings: BatterySettings | None = None) -> None:
        self.settings = settings or BatterySettings()
        self.percentage = self.settings.percentage
        """0 to 1."""
        self.current = 0.0
        """A, negative while it discharges, as ROS has it."""
        self.voltage = self.open_voltage
        """V with that current."""
        self._charger = False

    @property
    def open_voltage(self) -> float:
        """V without a load, by what it still holds."""
        settings, above = self.settings, max(1, bisect(CHARGES, self.percentage, hi=len(CHARGES) - 1))
        share = (self.percentage - CHARGES[above - 1]) / (CHARGES[above] - CHARGES[above - 1])
        level = LEVELS[above - 1] + share * (LEVELS[above] - LEVELS[above - 1])
        return settings.empty_voltage + level * (settings.full_voltage - settings.empty_voltage)

    @property
    def strength(self) -> float:
        """Share of the nominal voltage with that current, at most 1; 0 once it is empty."""
        return min(1.0, self.voltage / self.settings.nominal_voltage) if self.percentage > 0 else 0.0

    def draw(self, watts: float, dt: float) -> None:
        """Give that power for `dt` s; no more than it can, and nothing once it is empty."""
        self._charger = False
        self._pass(-max(0.0, watts) if self.percentage > 0 else 0.0, dt)

    def charge(self, watts: float, dt: float) -> None:
        """Take that power for `dt` s; nothing once it is full."""
        self._charger = True
        self._pass(max(0.0, watts) if self.percentage < 1 else 0.0, dt)

    def state(self, header: Header) -> BatteryState:
        """Return what a robot tells of it."""
        settings = self.settings
        return BatteryState(
            header,
            voltage=self.voltage,
            temperature=ROOM,
            current=self.current,
            charge=self.percentage * settings.capacity,
            capacity=settings.capacity,
            design_capacity=settings.capacity,
            percentage=self.percentage,
            power_supply_status=self._status,
            power_supply_health=GOOD,
            power_supply_technology=settings.technology,
            present=True,
            cell_voltage=[self.voltage / settings.cells] * settings.cells,
            cell_temperature=[ROOM] * settings.cells,
            location="",
            serial_number="",
        )

    @property
    def _status(self) -> int:
        if self._charger:
            return FULL if self.percentage >= 1 else CHARGING if self.current > 0 else NOT_CHARGING
        return DISCHARGING

    def _pass(self, watts: float, dt: float) -> None:
        resistance, rest = self.settings.resistance, self.open_voltage
        # watts = (rest + resistance * current) * current
        root = sqrt(max(0.0, rest * rest + 4 * resistance * watts))
        self.current = (root - rest) / (2 * resistance)
        self.voltage = rest + resistance * self.current
        gained = self.current * dt / 3600 / self.settings.capacity
        self.percentage = max(0.0, min(1.0, self.percentage + gained))
