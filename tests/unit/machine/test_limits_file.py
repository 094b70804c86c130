from pathlib import Path

import pytest

from zteleop.errors import DeviceError
from zteleop.machine.limits_file import LimitsFile


def test_what_is_kept_is_found_again_and_nothing_leaves_nothing(tmp_path: Path) -> None:
    file = LimitsFile(tmp_path / "robots" / "limits.json")
    assert file.load() == {}
    file.keep({"speed": 0.3})
    assert LimitsFile(tmp_path / "robots" / "limits.json").load() == {"speed": 0.3}
    file.keep({})
    file.keep({})
    assert list((tmp_path / "robots").iterdir()) == []


@pytest.mark.parametrize("text", [b"", b"[]", b'{"speed": "fast"}', b"\xff", b"[" * 10_000])
def test_a_file_of_anything_else_is_one_sentence(tmp_path: Path, text: bytes) -> None:
    (tmp_path / "limits.json").write_bytes(text)
    with pytest.raises(DeviceError, match=r"limits.json cannot be read: it is no list of limits$"):
        LimitsFile(tmp_path / "limits.json").load()


def test_a_folder_in_its_place_is_one_sentence_and_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "limits.json" / "x").mkdir(parents=True)
    file = LimitsFile(tmp_path / "limits.json")
    with pytest.raises(DeviceError, match="cannot be read: Is a directory"):
        file.load()
    with pytest.raises(DeviceError, match=r"limits.json: "):
        file.keep({"speed": 1.0})
    assert [path.name for path in tmp_path.iterdir()] == ["limits.json"]
