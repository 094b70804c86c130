"""Any bytes, cut anywhere, at any time: names of keys, never an error, never a lost Ctrl-C."""

from hypothesis import given, settings
from hypothesis import strategies as st

from zteleop.terminal.keys import Key, KeyParser, Report

PIECES = st.one_of(
    st.binary(max_size=6),
    st.sampled_from(
        [
            b"\x1b[",
            b"\x1bO",
            b"\x1b]",
            b"\x1bP",
            b"\x1b\\",
            b"\x1b[200~",
            b"\x1b[201~",
            b"\x1b[1;5:3A",
            b"\x1b[?15u",
            b"\x1b[122::119;1:3u",
            b"\x1b[O",
            b"\x03",
        ]
    ),
)


@settings(max_examples=500, deadline=None)
@given(st.lists(st.tuples(PIECES, st.floats(0, 1), st.booleans()), max_size=40))
def test_any_bytes_at_any_time_are_keys(pieces):
    parser, now = KeyParser(), 0.0
    for data, wait, flush in pieces:
        now += wait
        keys = parser.flush(now) if flush else []
        keys += parser.feed(data, now)
        assert all(isinstance(one, Report) or one.name for one in keys)
        assert keys.count(Key("ctrl-c")) >= data.count(b"\x03")
    parser.feed(b"\x03")
    assert parser.feed(b"q") == [Key("q")]
