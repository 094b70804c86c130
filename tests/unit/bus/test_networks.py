from pathlib import Path

import pytest

from zteleop.bus import networks


@pytest.mark.parametrize(
    ("devices", "is_in_none"),
    [
        ({"lo": "1\n"}, True),
        ({"lo": "1\n", "eth0": "0\n", "wlan0": None}, True),  # the carrier of what is down cannot be read
        ({"lo": "1\n", "eth0": "1\n"}, False),
        ({"lo": "1\n", "eth0": "0\n", "wlan0": "1\n"}, False),
        ({}, False),
    ],
)
def test_a_machine_is_in_no_network_when_no_device_has_a_carrier(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, devices: dict[str, str | None], is_in_none: bool
) -> None:
    monkeypatch.setattr(networks, "DEVICES", tmp_path)
    for name, carrier in devices.items():
        (tmp_path / name).mkdir()
        if carrier is not None:
            (tmp_path / name / "carrier").write_text(carrier)
    assert networks.is_in_none() is is_in_none


def test_where_nobody_knows_it_counts_as_in_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(networks, "DEVICES", tmp_path / "none")
    assert not networks.is_in_none()
