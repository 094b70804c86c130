"""Whether this machine is in any network: zenoh looks for others in networks, not on the machine itself."""

from pathlib import Path

LOOPBACK = "lo"
DEVICES = Path("/sys/class/net")
"""of Linux; elsewhere nobody knows"""


def is_in_none() -> bool:
    """Say whether no device but the machine's own has a carrier: no cable, and no Wi-Fi it has joined."""
    devices = list(DEVICES.glob("*"))
    return bool(devices) and not any(_has_carrier(device) for device in devices if device.name != LOOPBACK)


def _has_carrier(device: Path) -> bool:
    try:
        return (device / "carrier").read_text().strip() == "1"
    except OSError:  # of one that is down
        return False
