from pathlib import Path

import pytest

from zteleop.errors import RecordingError
from zteleop.recording.reading.bag_folder import files_of

ABOUT = "rosbag2_bagfile_information:\n  relative_file_paths:\n"


def test_a_file_is_itself(tmp_path: Path) -> None:
    assert files_of(tmp_path / "x.mcap") == [tmp_path / "x.mcap"]


def test_the_files_that_a_description_names_in_its_order(tmp_path: Path) -> None:
    (tmp_path / "a.mcap").touch()
    (tmp_path / "metadata.yaml").write_text(f"{ABOUT}  - b.mcap\n  - ../../etc/c.mcap\n")
    assert files_of(tmp_path) == [tmp_path / "b.mcap", tmp_path / "c.mcap"]


def test_without_a_description_every_file_in_the_order_of_names(tmp_path: Path) -> None:
    for name in ("b.mcap", "a.mcap", "notes.txt"):
        (tmp_path / name).touch()
    assert files_of(tmp_path) == [tmp_path / "a.mcap", tmp_path / "b.mcap"]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "hello",
        "rosbag2_bagfile_information: 3",
        "rosbag2_bagfile_information: {relative_file_paths: 3}",
        "rosbag2_bagfile_information: {relative_file_paths: []}",
        "{" * 2000,
        "[" * 5000,
        "a: !!python/object:os.system x",
        "\0",
    ],
)
def test_a_description_that_names_no_files_is_refused_in_words(text: str, tmp_path: Path) -> None:
    (tmp_path / "metadata.yaml").write_text(text)
    with pytest.raises(RecordingError, match=r"does not say which files|names no files"):
        files_of(tmp_path)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (f"{ABOUT}  - b.db3\n", "found b.db3; to turn them into MCAP say: pip install rosbags"),
        (f"{ABOUT}  - b.mcap.zstd\n  compression_mode: FILE\n", "packed by ros2 bag, by file"),
        (f"{ABOUT}  - b.mcap\n  compression_mode: MESSAGE\n", "packed by ros2 bag, by message"),
    ],
)
def test_what_is_not_read_is_said_with_what_to_do(text: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "metadata.yaml").write_text(text)
    with pytest.raises(RecordingError, match=words):
        files_of(tmp_path)


@pytest.mark.parametrize(
    ("name", "words"),
    [("x.txt", "found none in"), ("bag.db3", "SQLite"), ("manifest.json", "zteleop bag convert")],
)
def test_a_folder_without_a_recording_is_refused_in_words(name: str, words: str, tmp_path: Path) -> None:
    (tmp_path / name).touch()
    with pytest.raises(RecordingError, match=words):
        files_of(tmp_path)
