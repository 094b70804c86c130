"""A chip's oscillator by what a meter shows: boards are off by some percent, and every pulse with them."""

from msgspec.structs import replace

from zteleop.cli._settings_file import PULSES, Changes, of_servos
from zteleop.config import Config
from zteleop.drivers import settings_of
from zteleop.drivers.registers import TICKS
from zteleop.errors import ConfigError

LEAST_HZ, MOST_HZ = 20e6, 30e6
"""between which there are any"""


def measured(settings: Config, meter_hz: float) -> Changes:
    """Return what a config must say where a meter shows so many Hz at a channel while the actuator runs.

    Its pulses stay as long as they were, to a tick: it is what they were called in us that was wrong.

    Raises ConfigError for a driver without one, and for a frequency that no oscillator makes.
    """
    chip = settings_of(settings.driver, settings.driver_settings(settings.driver, settings.robot or ""))
    if not hasattr(chip, "osc_hz"):
        raise ConfigError(f"the oscillator is a PCA9685's, and the driver here is {settings.driver}")
    meant_hz = 1e6 / (TICKS * settings.tick_us)
    factor = meter_hz / meant_hz
    osc_hz = chip.osc_hz * factor
    if not LEAST_HZ <= osc_hz <= MOST_HZ:
        raise ConfigError(
            f"{meter_hz:g} Hz where {meant_hz:.1f} are meant makes an oscillator of {osc_hz / 1e6:.1f} MHz, "
            "which none is: measure at a channel with pulses, while zteleop actuator runs"
        )
    fields = (*PULSES, "dead_zone_us")
    servos = {
        name: replace(servo, **{field: getattr(servo, field) / factor for field in fields})
        for name, servo in settings.drive.servos.items()
    }
    drivers = {settings.driver, "pca9685"}  # the simulated chip stands for the one that was measured
    return {**of_servos(servos), **{("drivers", name, "osc_hz"): round(osc_hz) for name in sorted(drivers)}}
