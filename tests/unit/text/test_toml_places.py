import pytest

from zteleop.text.toml_places import place, places

TEXT = """
robot = "abe"   # \u2028 driver = "x"
[drive.limits]
  speed = 1
[ drive . "servos" . steering ]
channel = 1
bus.mode = 'peer'
[drive.limits]
speed = 2
note = '''
driver = "y"
'''
"""


@pytest.mark.parametrize(
    ("path", "at"),
    [
        (("robot",), (2, 1)),
        (("drive",), (3, 2)),
        (("drive", "limits"), (3, 2)),
        (("drive", "limits", "speed"), (4, 3)),
        (("drive", "limits", "turn"), (3, 2)),
        (("drive", "servos", "steering", "channel"), (6, 1)),
        (("drive", "servos", "steering", "bus", "mode"), (7, 1)),
        (("driver",), None),
        ((), None),
    ],
)
def test_each_name_stands_where_it_is_written_first(
    path: tuple[str, ...], at: tuple[int, int] | None
) -> None:
    assert place(places(TEXT), path) == at
