"""Files that are no recording, told apart by their first bytes, and what to do with each."""

from zteleop.errors import RecordingError
from zteleop.recording.reading.records import MAGIC
from zteleop.recording.reading.source import Source

CONVERT = "pip install rosbags, then: rosbags-convert --src {src} --dst NEW --dst-storage mcap"
KINDS = {
    b"#ROSBAG": f"a bag of ROS 1; to turn it into MCAP say: {CONVERT}",
    b"SQLite format 3\0": "a bag of ROS 2 in SQLite; to turn its folder into MCAP say: "
    + CONVERT.replace("{src}", "FOLDER"),
    b"\x28\xb5\x2f\xfd": "a file packed by zstd; unpack it, and try again: zstd -d {src}",
    b"\x04\x22\x4d\x18": "a file packed by lz4; unpack it, and try again: lz4 -d {src}",
    b"\x1f\x8b": "a file packed by gzip; a black box is shown by: zteleop blackbox {src}",
}
"""by how a file begins"""
_LONGEST = max(map(len, KINDS))


def check(source: Source, broken: bool = False) -> None:
    """Raise RecordingError when a file is no recording; with `broken` its beginning may be, too."""
    begins = source.some(0, _LONGEST)
    if begins.startswith(MAGIC):
        return
    if not begins:
        raise RecordingError(f"{source.path} is empty")
    if MAGIC.startswith(begins):
        raise RecordingError(
            f"{source.path} was cut off after {len(begins)} bytes: nothing of a recording is in it"
        )
    for start, words in KINDS.items():
        if begins.startswith(start):
            raise RecordingError(f"expected a recording (MCAP), found {words.format(src=source.path)}")
    if not broken:
        raise RecordingError(f"expected a recording (MCAP), found another kind of file: {source.path}")
