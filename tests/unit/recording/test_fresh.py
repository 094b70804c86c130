import errno
from pathlib import Path

import pytest

from zteleop.errors import RecordingError
from zteleop.recording.fresh import fresh


def fail(path: Path, error: BaseException) -> None:
    """Write something, and fail."""
    path.write_text("x")
    raise error


def test_a_file_has_its_name_when_it_is_whole(tmp_path: Path) -> None:
    with fresh(tmp_path / "a") as place:
        place.write_text("x")
        assert not (tmp_path / "a").exists()
    assert [path.name for path in tmp_path.iterdir()] == ["a"]


def test_a_folder_has_its_name_when_it_is_whole(tmp_path: Path) -> None:
    with fresh(tmp_path / "a/", folder=True) as place:
        (place / "inner").write_text("x")
    assert (tmp_path / "a/inner").read_text() == "x"


@pytest.mark.parametrize("there", ["file", "folder", "dangling link"])
def test_what_is_there_is_not_touched(tmp_path: Path, there: str) -> None:
    path = tmp_path / "a"
    if there == "file":
        path.write_text("mine")
    elif there == "folder":
        path.mkdir()
    else:
        path.symlink_to(tmp_path / "nowhere")
    with pytest.raises(RecordingError, match="is there already, and is not overwritten"), fresh(path):
        pytest.fail("it was written")
    assert len(list(tmp_path.iterdir())) == 1


def test_what_appears_meanwhile_is_not_overwritten(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="is there already"), fresh(tmp_path / "a"):
        (tmp_path / "a").write_text("mine")
    assert (tmp_path / "a").read_text() == "mine"
    assert len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("folder", [False, True])
def test_of_what_failed_nothing_is_left(tmp_path: Path, folder: bool) -> None:
    with (
        pytest.raises(RecordingError, match=r"cannot write .*a: No space left on device; what was written"),
        fresh(tmp_path / "a", folder=folder) as place,
    ):
        fail(place / "x" if folder else place, OSError(errno.ENOSPC, "No space left on device"))
    assert list(tmp_path.iterdir()) == []


def test_an_interruption_leaves_nothing_and_goes_on(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt), fresh(tmp_path / "a", folder=True) as place:
        fail(place / "x", KeyboardInterrupt())
    assert list(tmp_path.iterdir()) == []


def test_another_that_is_being_written_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "a.part").write_text("theirs")
    with (
        pytest.raises(RecordingError, match=r"a\.part is there already: it is being written"),
        fresh(tmp_path / "a"),
    ):
        pytest.fail("it was written")
    assert (tmp_path / "a.part").read_text() == "theirs"


def test_a_folder_that_is_not_there_is_said(tmp_path: Path) -> None:
    with (
        pytest.raises(RecordingError, match=r"cannot write .*b: No such file or directory$"),
        fresh(tmp_path / "a/b") as place,
    ):
        place.write_text("x")
