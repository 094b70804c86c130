from pathlib import Path

import pytest

from zteleop.cameras import Wanted, sources

WANTED = Wanted(320, 240, 15, 60)


def words(device: str | None, wanted: Wanted = WANTED) -> list[str]:
    return [" ".join(source.command) for source in sources(device, wanted)]


def test_a_camera_that_makes_jpegs_is_copied_and_only_another_is_encoded() -> None:
    own, encoded = words("/dev/video3")
    for line in (own, encoded):
        assert " -f v4l2 " in line
        assert " -framerate 15 -video_size 320x240 -i /dev/video3 " in line
    assert " -input_format mjpeg " in own
    assert " -c:v copy " in own
    assert "mjpeg -framerate" not in encoded
    assert " -c:v mjpeg " in encoded


def test_the_pis_camera_is_its_own_program() -> None:
    (line,) = words("rpicam")
    assert line.startswith("rpicam-vid --timeout 0 --nopreview --codec mjpeg --quality 60 ")
    assert line.endswith(" --width 320 --height 240 --framerate 15 --output -")


def test_without_a_name_every_camera_is_tried_and_nothing_that_is_none(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    there = [Path(f"/dev/video{number}") for number in (10, 2, 0)]
    monkeypatch.setattr(Path, "glob", lambda folder, pattern: iter(there))
    shows = [source.shows for source in sources(None, WANTED)]
    assert shows == ["the Pi's camera", *(f"/dev/video{n}" for n in (0, 0, 2, 2, 10, 10))]


def test_a_film_is_shown_again_and_again() -> None:
    (line,) = words("films/way.mp4")
    assert " -stream_loop -1 -i file:films/way.mp4 -r 15 -s 320x240 " in line


@pytest.mark.parametrize(("quality", "scale"), [(100, 2), (80, 8), (1, 31)])
def test_the_best_quality_is_the_least_of_ffmpeg(quality: int, scale: int) -> None:
    (line,) = words("test", WANTED._replace(quality=quality))
    assert f" -q:v {scale} " in line
