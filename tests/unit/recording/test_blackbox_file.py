import gzip
import json
import os
from pathlib import Path

import pytest

from zteleop.bus import codec
from zteleop.bus.tap import Raw
from zteleop.control.proof import Proof
from zteleop.errors import ConfigError
from zteleop.messages import Beat
from zteleop.recording import blackbox_file
from zteleop.recording.blackbox_file import KEPT, Header, Reason, read, utc, write

PROOF = Proof(1, 2, 3, 4.0, 5.0, 6.0)
BEAT = Raw(7.123456, "beat", codec.encoding_of(Beat), codec.encode(Beat(3, 7.0, 0.0)), b"", False)


def header(reason: str = "stop", second: int = 0) -> Header:
    return Header(
        blackbox=1,
        robot="archangel",
        version="1",
        at=8.0,
        time=utc(1_700_000_000 + second),
        reason=reason,
        why="so",
        span=1.0,
        topics=1,
        triggers=[Reason(8.0, reason, "so")],
        floods={"junk": [(7, 300)]},
    )


def line(raw: Raw) -> dict[str, object]:
    """Return what is kept of a message, as anybody reads it."""
    return json.loads(blackbox_file.msgspec.json.encode(blackbox_file.line_of(raw, "archangel")))


def test_a_message_is_kept_as_its_values() -> None:
    assert line(BEAT) == {
        "at": 7.1235,
        "key": "robot/archangel/beat",
        "encoding": "application/json;zteleop_msgs/msg/Beat",
        "payload": {"epoch": 3, "time": 7.0, "floor": 0.0},
    }


def test_a_proof_is_kept_in_its_parts_and_any_other_attachment_as_it_is() -> None:
    assert line(BEAT._replace(attachment=codec.pack_proof(PROOF)))["proof"] == list(PROOF)
    assert line(BEAT._replace(attachment=b"abc"))["attachment"] == "YWJj"


@pytest.mark.parametrize(
    "payload", [b"\xff\xfe", b"", b"{", b"[" * 100_000, b"1" + b"0" * 400, b'"\xff"', b"NaN"]
)
def test_bytes_that_are_no_json_are_kept_as_they_are(payload: bytes) -> None:
    raw = BEAT._replace(path="lidar", payload=payload)
    kept = line(raw)
    assert "payload" not in kept or json.loads(payload) == kept["payload"]
    assert "payload" in kept or blackbox_file.base64.b64decode(str(kept["base64"])) == payload


def test_a_wildcard_keeps_its_whole_key() -> None:
    assert line(BEAT._replace(path="robot/*/beat"))["key"] == "robot/*/beat"


def test_a_line_says_why_nobody_could_read_it() -> None:
    assert "wrong" not in line(BEAT._replace(path="lidar", payload=b"{"))
    assert "not a zteleop_msgs/msg/Beat" in str(line(BEAT._replace(payload=b"{"))["wrong"])
    assert "found 'text/plain'" in str(line(BEAT._replace(encoding="text/plain"))["wrong"])
    assert line(BEAT._replace(deleted=True))["wrong"] == "a delete or a wildcard is no message"


def test_what_is_written_is_read(tmp_path: Path) -> None:
    path = write(tmp_path / "new" / "folder", header(), [BEAT, BEAT._replace(at=8.0)])
    assert path.name == "20231114T221320.000-stop.jsonl.gz"
    recording = read(path)
    assert recording.header == header()
    assert [kept.at for kept in recording.lines] == [7.1235, 8.0]
    assert recording.lines[0].payload == {"epoch": 3, "time": 7.0, "floor": 0.0}
    assert not recording.trouble
    assert os.listdir(path.parent) == [path.name]


def test_the_newest_of_each_reason_are_kept(tmp_path: Path) -> None:
    for second in range(KEPT + 3):
        path = write(tmp_path, header("fault", second), [])
        os.utime(path, (second, second))
    write(tmp_path, header("stop", 0), [])
    kept = [(path.name[13:15], blackbox_file.reason_of(path)) for path in blackbox_file.files(tmp_path)]
    assert kept == [(f"{23 + n}", "fault") for n in range(KEPT)] + [("20", "stop")]


def test_on_a_clock_that_went_back_the_file_just_written_stays(tmp_path: Path) -> None:
    for second in range(KEPT):
        path = write(tmp_path, header("stop", 100 + second), [])
        os.utime(path, (4e9, 4e9))
    newest = write(tmp_path, header("stop", -1_600_000_000), [])
    assert newest in blackbox_file.files(tmp_path)
    assert len(blackbox_file.files(tmp_path)) == KEPT


def test_a_disk_that_is_full_leaves_nothing_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(file: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        write(tmp_path, header(), [BEAT])
    assert os.listdir(tmp_path) == []


def test_what_was_being_written_when_the_power_went_is_removed(tmp_path: Path) -> None:
    path = write(tmp_path, header(), [])
    old, young = (tmp_path / f".{path.name}.{number}" for number in (7, 8))
    for half in (old, young):
        half.write_bytes(b"half")
    os.utime(old, (0, 0))
    write(tmp_path, header(), [])
    assert {found.name for found in tmp_path.iterdir()} == {path.name, young.name}


def test_a_folder_that_is_a_file_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="exists"):
        write(tmp_path / "file", header(), [])


def test_a_file_that_somebody_unpacked_is_read_too(tmp_path: Path) -> None:
    plain = tmp_path / "plain"
    plain.write_bytes(gzip.decompress(write(tmp_path, header(), [BEAT]).read_bytes()))
    assert len(read(plain).lines) == 1


def incompressible(number: int) -> list[Raw]:
    return [BEAT._replace(path="lidar", payload=os.urandom(3000)) for _ in range(number)]


def test_of_a_file_without_its_end_the_beginning_is_read(tmp_path: Path) -> None:
    path = write(tmp_path, header(), incompressible(100))
    path.write_bytes(path.read_bytes()[:150_000])
    recording = read(path)
    assert 20 < len(recording.lines) < 100
    assert recording.trouble == "its end is missing"


def test_of_a_damaged_file_what_comes_before_is_read(tmp_path: Path) -> None:
    path = write(tmp_path, header(), incompressible(1000))
    data = bytearray(path.read_bytes())
    middle = len(data) // 2
    data[middle : middle + 10_000] = bytes(10_000)
    path.write_bytes(data)
    recording = read(path)
    assert len(recording.lines) < 1000
    assert recording.trouble


def test_lines_that_are_none_are_counted(tmp_path: Path) -> None:
    plain = tmp_path / "plain"
    good = gzip.decompress(write(tmp_path, header(), [BEAT]).read_bytes())
    plain.write_bytes(good + b'{"at": "noon"}\n[]\n' + b"[" * 100_000 + b"\n")
    recording = read(plain)
    assert len(recording.lines) == 1
    assert recording.trouble == "3 lines of it cannot be read"


def test_more_than_anybody_writes_is_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write(tmp_path, header(), [BEAT] * 1000)
    monkeypatch.setattr(blackbox_file, "LARGEST", 10_000)
    recording = read(path)
    assert 0 < len(recording.lines) < 1000
    assert "is left out" in recording.trouble


@pytest.mark.parametrize(
    "data", [b"", b"hello", b"\x1f\x8b\x08", b"{}\n", gzip.compress(b"hello\n", mtime=0), b"[" * 10**6]
)
def test_what_is_no_black_box_is_said_to_be_none(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "x.gz"
    path.write_bytes(data)
    with pytest.raises(ConfigError, match="no black box of zteleop"):
        read(path)


def test_a_file_that_is_not_there_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"cannot read .*: No such file"):
        read(tmp_path / "none")
    with pytest.raises(ConfigError, match=r"cannot read .*: Is a directory"):
        read(tmp_path)


def test_a_proof_that_no_reader_could_read_back_stays_bytes() -> None:
    strange = codec.pack_proof(PROOF._replace(beat=float("nan")))
    kept = line(BEAT._replace(attachment=strange))
    assert "proof" not in kept
    assert kept["attachment"]


def test_a_proof_of_what_never_began_keeps_its_sender() -> None:
    attachment = codec.pack_proof(PROOF._replace(acted=float("-inf"), began=float("-inf")))
    kept = blackbox_file._proof(attachment)
    assert kept is not None
    assert (kept.sender, kept.seq, kept.beat) == (PROOF.sender, PROOF.seq, PROOF.beat)
    assert kept.began == kept.acted == blackbox_file.LONG_AGO
