import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.terminal.keys import ESCAPE_WAIT, Key, KeyParser, Report, meaning


def keys(data: bytes) -> list[str]:
    return names(KeyParser().feed(data))


def names(found: list[Key | Report]) -> list[str]:
    return [one.name for one in found if isinstance(one, Key)]


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"wasd", ["w", "a", "s", "d"]),
        (b"\x1b[A\x1b[B\x1b[C\x1b[D", ["up", "down", "right", "left"]),
        (b"\x1bOA\x1bOB\x1bOC\x1bOD", ["up", "down", "right", "left"]),
        (b" \r\n\t\x7f\x08", ["space", "enter", "enter", "tab", "backspace", "backspace"]),
        (b"\x03\x04\x0c\x1a\x00", ["ctrl-c", "ctrl-d", "ctrl-l", "ctrl-z", "ctrl-space"]),
        (b"\x1bOP\x1b[15~\x1b[24~\x1b[[A", ["f1", "f5", "f12", "f1"]),
        (b"\x1b[H\x1b[F\x1b[3~\x1b[5~", ["home", "end", "delete", "pageup"]),
        ("é文😀".encode(), ["é", "文", "😀"]),
        (b"\x1bw", ["alt-w"]),
        (b"\x1b\x1b[A", ["escape", "up"]),
        (b"\x1b[99;5u\x1b[113u\x1b[27u", ["ctrl-c", "q", "escape"]),
    ],
)
def test_keys_have_names(data, expected):
    assert keys(data) == expected


@pytest.mark.parametrize(
    ("data", "expected"),
    [(b"\x1b[1;2A", "up"), (b"\x1b[1;5A", "ctrl-up"), (b"\x1b[1;3D", "alt-left"), (b"\x1b[1;129C", "right")],
)
def test_shift_and_locks_keep_the_name_and_ctrl_and_alt_change_it(data, expected):
    assert keys(data) == [expected]


@pytest.mark.parametrize(
    "data",
    [
        b"\x1b[?62;4c",
        b"\x1b[?1A",
        b"\x1b[I\x1b[O",
        b"\x1b[<0;10;20M",
        b"\x1b[Mwas",
        b"\x1b[1;1:4A",
        b"\x1b]11;rgb:ffff/wasd/0000\x07",
        b"\x1bPwasd\x1b\\",
        b"\x1b[57441u",
        b"\x1b[" + b"1" * 10_000 + b"A",
        b"\x1b[1 A",
    ],
)
def test_what_is_no_key_is_swallowed_whole(data):
    assert keys(data + b"x") == ["x"]


def test_a_paste_is_no_key_whatever_is_in_it():
    assert keys(b"u\x1b[200~wwww\x1b[Aqq\r\x1b[200~w\x1b[201~j") == ["u", "j"]


def test_ctrl_c_is_heard_even_in_the_middle_of_anything():
    for begun in (b"\x1b", b"\x1b[", b"\x1b[1;", b"\x1bO", b"\x1bPw", b"\x1b[200~w", b"\x1b[M", b"\xe6"):
        assert keys(begun + b"\x03q") == ["ctrl-c", "q"]


def test_escape_alone_is_a_key_once_nothing_followed():
    parser = KeyParser()
    assert parser.feed(b"\x1b", now=1.0) == []
    assert parser.flush(1.0 + ESCAPE_WAIT / 2) == []
    assert parser.flush(1.0 + 2 * ESCAPE_WAIT) == [Key("escape")]
    assert names(parser.feed(b"[A", now=1.2)) == ["[", "A"]


def test_a_sequence_cut_off_for_good_does_not_eat_the_next_key():
    parser = KeyParser()
    parser.feed(b"\x1b]", now=1.0)
    assert parser.flush(2.0) == []
    assert parser.feed(b"q", now=2.0) == [Key("q")]


def test_a_paste_that_stalls_stays_a_paste():
    parser = KeyParser()
    parser.feed(b"\x1b[200~ww", now=1.0)
    assert parser.flush(60.0) == []
    assert parser.feed(b"ww\x1b[201~x", now=60.0) == [Key("x")]


def test_bytes_that_are_no_text_harm_nothing():
    assert keys(b"\xff\xfew\xc3(\xe6\x96q") == ["w", "(", "q"]


def test_an_endless_sequence_takes_no_memory():
    for begin in (b"\x1b[", b"\x1bP", b"\x1b[200~"):
        parser = KeyParser()
        parser.feed(begin + b"0" * 200_000)
        assert len(parser._sequence) < 100


PIECES = st.sampled_from(
    [
        b"\x1b",
        b"[",
        b"O",
        b"A",
        b"1;5",
        b"~",
        b"\x1b[200~",
        b"\x1b[201~",
        b"w",
        b"\x03",
        b"\xc3\xa9",
        b"\x1b[M",
    ]
)


@given(st.lists(st.one_of(PIECES, st.binary(max_size=4))).map(b"".join), st.lists(st.integers(0, 60)))
def test_every_split_gives_the_same_keys(data, cuts):
    parser, split, start = KeyParser(), [], 0
    for cut in [*sorted(cuts), len(data)]:
        split += parser.feed(data[start:cut])
        start = max(start, cut)
    assert split == KeyParser().feed(data)


@given(st.text(max_size=40), st.characters())
def test_any_sequence_has_a_name_or_none(parameters, final):
    found = meaning(parameters, final)
    assert found is None or isinstance(found, Report) or found.name


@pytest.mark.parametrize(
    ("data", "key"),
    [
        (b"\x1b[119u", Key("w", "press", "w")),
        (b"\x1b[119;1:2u", Key("w", "repeat", "w")),
        (b"\x1b[119;1:3u", Key("w", "release", "w")),
        (b"\x1b[1;1:3A", Key("up", "release", "up")),
        (b"\x1b[127;1:2u", Key("backspace", "repeat", "backspace")),
        (b"\x1b[99;5:1u", Key("ctrl-c", "press", "c")),
        (b"\x1b[119;5:3u", Key("ctrl-w", "release", "w")),
        (b"\x1b[57419;1:3u", Key("up", "release", "up")),
    ],
)
def test_a_terminal_may_tell_what_happened_to_a_key(data, key):
    assert KeyParser().feed(data) == [key]


@pytest.mark.parametrize(
    ("data", "name"),
    [
        (b"\x1b[1094::119u", "w"),  # Cyrillic
        (b"\x1b[122::119u", "w"),  # AZERTY
        (b"\x1b[119:87;2u", "w"),
        (b"\x1b[47:63;2u", "?"),
        (b"\x1b[223:63:45;2u", "?"),  # German
        (b"\x1b[119;9u", "super-w"),
    ],
)
def test_a_key_is_called_by_its_place_and_a_sign_by_what_shift_makes_of_it(data, name):
    assert keys(data) == [name]


@pytest.mark.parametrize(
    ("data", "report"),
    [
        (b"\x1b[?62;4c", Report("attributes")),
        (b"\x1b[?15u", Report("protocol", 15)),
        (b"\x1b[?0u", Report("protocol", 0)),
        (b"\x1b[I", Report("focus", 1)),
        (b"\x1b[O", Report("focus", 0)),
    ],
)
def test_what_a_terminal_says_of_itself_is_told(data, report):
    assert KeyParser().feed(data) == [report]


@pytest.mark.parametrize("data", [b"\x1b[?u", b"\x1b[?1;2u", b"\x1b[1I", b"\x1b[?25h", b"\x1b[?\xb2u"])
def test_what_is_no_report_is_none(data):
    assert not any(isinstance(one, Report) for one in KeyParser().feed(data))
