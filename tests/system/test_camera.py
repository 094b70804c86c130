"""Pictures of a camera on the bus: whole, new, and no more of them than a link takes."""

import os
import re
import shutil
import signal
import stat
import sys
import time
from collections.abc import Iterator
from io import BytesIO
from itertools import pairwise
from pathlib import Path

import pytest
from PIL import Image
from processes import Process, descendants
from rig import Rig, every, free_port, hear, until

from zteleop.bus.node_parameters import NodeParameters
from zteleop.chaos.cable import Cable
from zteleop.interfaces.parameters import from_python
from zteleop.messages import CompressedImage, Parameter

TOPIC = "camera/image/compressed"
needs_ffmpeg = pytest.mark.skipif(not shutil.which("ffmpeg"), reason="not here: ffmpeg (Debian: ffmpeg)")
RPICAM = """\
#!{python}
# What rpicam-vid does, as far as its manual says: JPEGs on standard output, and what is wrong on the other.
import sys, time

assert "--timeout 0" in " ".join(sys.argv)
assert sys.argv[-2:] == ["--output", "-"]
{body}
"""
GIVES = "while True:\n    sys.stdout.buffer.write({jpeg!r})\n    sys.stdout.flush()\n    time.sleep(0.02)"
FREEZES = "sys.stdout.buffer.write({jpeg!r})\nsys.stdout.flush()\ntime.sleep(3600)"
HAS_NONE = "sys.exit('ERROR: *** no cameras available ***')"


def jpeg(shade: int) -> bytes:
    file = BytesIO()
    Image.new("RGB", (64, 48), (shade, 0, 0)).save(file, "JPEG")
    return file.getvalue()


def pi(rig: Rig, body: str) -> None:
    """Put a rpicam-vid where it is found."""
    file = rig.folder / "bin" / "rpicam-vid"
    file.parent.mkdir(exist_ok=True)
    new = file.with_suffix(".new")
    new.write_text(RPICAM.format(python=sys.executable, body=body.format(jpeg=jpeg(200))))
    new.chmod(new.stat().st_mode | stat.S_IXUSR)
    new.replace(file)


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[Rig]:
    with Rig(tmp_path) as bench:
        bench.environment["PATH"] = f"{tmp_path / 'bin'}:{os.environ['PATH']}"
        bench.actuator()
        yield bench


def camera(rig: Rig, *words: str) -> Process:
    process = rig.join("camera", *words)
    process.says("camera: info: says what ")
    return process


@needs_ffmpeg
def test_pictures_come_and_are_whole(rig: Rig) -> None:
    pictures = rig.node().subscription(TOPIC, CompressedImage)
    camera(rig, "test", "--size", "320x240")
    stamps = set()
    for _ in range(5):
        picture = hear(pictures, lambda said: True, "a picture")
        assert picture.format == "jpeg"
        with Image.open(BytesIO(picture.data)) as image:
            image.load()
            assert image.size == (320, 240)
        stamps.add((picture.header.stamp.sec, picture.header.stamp.nanosec))
    assert len(stamps) == 5


def test_without_a_name_it_is_the_pis_camera_and_one_that_ends_is_started_again(rig: Rig) -> None:
    pi(rig, GIVES)
    pictures = rig.node().subscription(TOPIC, CompressedImage)
    process = camera(rig)
    assert "says what the Pi's camera shows, on bench/camera/image/compressed" in process.text
    hear(pictures, lambda said: said.data == jpeg(200), "the Pi's picture")
    pi(rig, FREEZES)
    for pid in descendants(process.process.pid):
        os.kill(pid, signal.SIGKILL)
    process.says("the Pi's camera gives no picture any more: its program has ended; it is started anew")
    process.says("the Pi's camera gives no picture any more: no picture for 2 s; it is started anew")
    pi(rig, GIVES)
    for _ in range(3):
        list(pictures.take())
        hear(pictures, lambda said: said.data == jpeg(200), "the Pi's picture")
    process.signal(signal.SIGINT)
    assert process.ends() == 130


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], r"no camera gives a picture: the Pi's camera: ERROR: \*\*\* no cameras available \*\*\*.*"),
        (["/dev/nosuch0"], r"there is no /dev/nosuch0; cameras here: "),
    ],
)
def test_without_a_camera_it_says_what_there_is_instead(rig: Rig, words: list[str], told: str) -> None:
    pi(rig, HAS_NONE)
    result = rig.result("camera", *rig.bus_options(), *words)
    assert result.returncode == 1
    assert re.search(f"^zteleop camera: {told}", result.stderr.splitlines()[-1])
    instead = "; a simulated one: zteleop sim --scene track --camera; a test picture: zteleop camera test\n"
    assert result.stderr.endswith(instead)


def test_two_cameras_of_one_robot_are_one_too_many(rig: Rig) -> None:
    pi(rig, GIVES)
    where = f"tcp/127.0.0.1:{free_port()}"
    camera(rig, "--listen", where)
    second = rig.result("camera", *rig.bus_options(), "--connect", where)
    assert second.returncode == 1
    assert re.search(r"camera on \S+ says what the camera of bench sees already; end that", second.stderr)


def test_whoever_watches_makes_it_slower_and_another_quality_begins_it_anew(rig: Rig) -> None:
    pi(rig, GIVES)
    process = camera(rig, "--rate", "60")
    node = rig.node()
    pictures = node.subscription(TOPIC, CompressedImage, depth=100)
    hear(pictures, lambda said: True, "a picture")
    parameters = NodeParameters(node.membership.session, rig.robot, "camera")  # by a link that is there
    assert parameters.set([Parameter("rate", from_python(0.5))])[0].successful
    hear(pictures, lambda said: True, "a picture")
    list(pictures.take())
    stamps = [hear(pictures, lambda said: True, "a picture").header.stamp for _ in range(3)]
    seconds = [stamp.sec + stamp.nanosec * 1e-9 for stamp in stamps]
    assert all(after - before > 1.5 for before, after in pairwise(seconds))
    before = descendants(process.process.pid)
    assert parameters.set([Parameter("quality", from_python(30))])[0].successful
    until(lambda: before != descendants(process.process.pid), "another rpicam-vid")


SLOW, KEPT = 100_000, 65_536
"""bytes a second that a link takes, and that wait in it"""


@needs_ffmpeg
def test_on_a_slow_link_pictures_are_fewer_and_not_older(rig: Rig) -> None:
    with Cable(rig.port, queue=KEPT) as cable:
        far = f"tcp/127.0.0.1:{cable.port}"
        pictures = rig.node().subscription(TOPIC, CompressedImage)
        cable.rate = SLOW
        process = rig.run("camera", "test", *rig.bus_options(far))
        process.says("camera: warning: the slowest link takes ")
        ages = []
        for _ in every(0.01, 2000):
            for received in pictures.take():
                stamp = received.message.header.stamp
                ages.append(time.time() - stamp.sec - stamp.nanosec * 1e-9)
            if len(ages) >= 20:
                break
        assert len(ages) >= 20
        assert sorted(ages)[10] < 5.0, "without a limit some megabytes wait: 40 s"
