"""A folder that is a recording: the files that rosbag2 names in its description, else all there are."""

from pathlib import Path
from typing import Any

from zteleop.errors import RecordingError
from zteleop.recording.reading.other_files import CONVERT

SUFFIX = ".mcap"
METADATA = "metadata.yaml"
LONGEST = 2**24
"""bytes of a description"""
MANIFEST = "manifest.json"
"""what a Donkeycar tub has"""


def files_of(path: Path) -> list[Path]:
    """Return the files of a recording in their order; raises RecordingError when there are none."""
    if not path.is_dir():
        return [path]
    if (about := path / METADATA).is_file():
        return _named(about)
    try:
        found = sorted(path.glob(f"*{SUFFIX}"))
    except OSError as error:
        raise RecordingError(f"cannot read {path}: {error.strerror}") from None
    if not found:
        raise RecordingError(_none_in(path))
    return found


def _named(about: Path) -> list[Path]:
    """Return the files that a description names."""
    told = _information(about)
    names = told.get("relative_file_paths")
    if not isinstance(names, list) or not names:
        raise RecordingError(f"{about} names no files; expected relative_file_paths")
    _check_compression(about, told)
    files = [about.parent / Path(str(name)).name for name in names]
    others = [file.name for file in files if file.suffix != SUFFIX]
    if others:
        folder = about.parent
        raise RecordingError(
            f"expected {SUFFIX} files in {folder}, found {', '.join(others)}; "
            f"to turn them into MCAP say: {CONVERT.format(src=folder)}"
        )
    return files


def _information(about: Path) -> dict[str, Any]:
    import yaml  # which a file alone does not need

    try:
        with about.open("rb") as file:
            told = yaml.load(file.read(LONGEST), Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
        found = told["rosbag2_bagfile_information"]
    except (OSError, UnicodeDecodeError, yaml.YAMLError, LookupError, TypeError, ValueError) as error:
        raise RecordingError(f"{about} does not say which files it describes: {error}") from None
    except RecursionError:
        raise RecordingError(f"{about} does not say which files it describes") from None
    if not isinstance(found, dict):
        raise RecordingError(f"{about} does not say which files it describes")
    return found


def _check_compression(about: Path, told: dict[str, Any]) -> None:
    """Raise RecordingError where each message, or each file, is packed for itself."""
    mode = str(told.get("compression_mode") or "none").lower()
    if mode not in ("none", "storage"):
        raise RecordingError(
            f"{about.parent} is packed by ros2 bag, by {mode}, which is not read here; "
            f"to unpack it say: {CONVERT.format(src=about.parent)}"
        )


def _none_in(path: Path) -> str:
    if (path / MANIFEST).is_file():
        return f"{path} is a Donkeycar tub; to turn it into a recording say: zteleop bag convert {path}"
    wanted = f"expected a recording, a {SUFFIX} file or a folder of them; found none in {path}"
    if any(path.glob("*.db3")):
        return f"{wanted}, but a bag of ROS 2 in SQLite; say: {CONVERT.format(src=path)}"
    return wanted
