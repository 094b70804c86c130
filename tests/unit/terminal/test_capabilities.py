import pytest

from zteleop.terminal.capabilities import speaks_unicode, wants_color


@pytest.mark.parametrize(
    ("environ", "color"),
    [
        ({"TERM": "xterm"}, True),
        ({"TERM": "xterm", "NO_COLOR": "1"}, False),
        ({"TERM": "dumb"}, False),
        ({}, False),
    ],
)
def test_colour_is_a_matter_of_taste(environ, color):
    assert wants_color(environ) is color


@pytest.mark.parametrize(
    ("environ", "encoding", "unicode"),
    [
        ({"LANG": "de_DE.UTF-8"}, "ascii", True),
        ({"LANG": "de_DE.UTF-8", "LC_ALL": "C"}, "utf-8", False),
        ({"LC_CTYPE": "C.utf8"}, None, True),
        ({"LC_CTYPE": "C.UTF-8", "LANG": "C"}, "utf-8", False),
        ({"LANG": "de_DE.ISO-8859-1"}, "utf-8", False),
        ({}, "UTF-8", True),
        ({}, None, False),
        ({"LANG": "C.UTF-8", "TERM": "linux"}, "utf-8", False),
    ],
)
def test_unicode_is_the_locales_word(environ, encoding, unicode):
    assert speaks_unicode(environ, encoding) is unicode
