from io import BytesIO

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from zteleop.cameras.jpegs import LONGEST, Jpegs


def jpeg(shade: int = 0, **options: object) -> bytes:
    file = BytesIO()
    Image.new("RGB", (16, 8), (shade, 90, 200)).save(file, "JPEG", **options)
    return file.getvalue()


def with_thumbnail(picture: bytes, inner: bytes) -> bytes:
    """Return a picture with another one in a segment of its own, as cameras write them."""
    segment = b"\xff\xe1" + (len(inner) + 2).to_bytes(2) + inner
    return picture[:2] + segment + picture[2:]


PICTURES = [
    jpeg(),
    jpeg(200, quality=20),
    jpeg(30, progressive=True),
    with_thumbnail(jpeg(60), jpeg(70)),
    b"\xff\xd8\xff" + jpeg(90)[2:],  # a byte that fills
]


@given(st.lists(st.integers(1, 400), max_size=40), st.permutations(PICTURES))
def test_pictures_are_found_whole_however_they_are_cut(cuts: list[int], pictures: list[bytes]) -> None:
    stream, jpegs, found = b"".join(pictures), Jpegs(), list[bytes]()
    for cut in [*cuts, len(stream)]:
        found += jpegs.take(stream[:cut])
        stream = stream[cut:]
    assert found == pictures
    assert jpegs.dropped == 0


@pytest.mark.parametrize(
    "rubbish", [b"\r\n--frame\r\n", b"\x00" * 99, b"\xff", b"\xff\xd8", b"\xff\xd8\xff\xe0\x00"]
)
def test_what_is_no_picture_is_passed_by_and_counted(rubbish: bytes) -> None:
    jpegs = Jpegs()
    found = [*jpegs.take(jpeg(1) + rubbish), *jpegs.take(b"ab" + jpeg(2) + jpeg(3))]
    assert found[0] == jpeg(1)
    assert found[-1] == jpeg(3)
    assert jpegs.dropped >= 1


def test_what_never_ends_is_not_kept_for_ever() -> None:
    jpegs = Jpegs()
    assert list(jpegs.take(jpeg()[:-2] + bytes(LONGEST // 2))) == []
    assert jpegs.dropped == 0, "it may end yet"
    assert list(jpegs.take(bytes(LONGEST // 2))) == []
    assert jpegs.dropped == 1
    assert list(jpegs.take(jpeg(5))) == [jpeg(5)]
