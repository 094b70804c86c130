import os

import pytest

from zteleop.machine import leftovers
from zteleop.machine.leftovers import Running, read, running

TOLD = """\
  101     1 ?        Ssl   02:13:05 /usr/bin/python3 -m zteleop actuator --robot archangel
  102   101 ?        Sl    02:13:04 /usr/bin/python3 -m zteleop.processes actuator 4 5
  103     1 ??       R     2-01:00:00 /opt/Python.app/Contents/MacOS/Python -m zteleop.processes blackbox 4
  104    99 pts/3    Tl    00:07 /home/ann/.venv/bin/python /home/ann/.venv/bin/zteleop keyboard
  105    99 pts/3    S+    00:07 /home/ann/.venv/bin/zteleop sim
  106    99 pts/3    S+    00:07 vim zteleop notes
  107    99 pts/3    S+    00:07 python3 zteleop
  108    99 pts/3    S+    00:07 bash -c zteleop actuator
  109    99 pts/3    S+    00:07 [kworker/0:1]
nonsense
"""


def test_who_was_typed_is_told_and_where_nobody_sits() -> None:
    assert list(read(TOLD)) == [
        Running(101, "actuator", "02:13:05", False),
        Running(103, "blackbox", "2-01:00:00", False),
        Running(104, "keyboard", "00:07", True, frozen=True),
        Running(105, "sim", "00:07", True),
    ]


def test_this_machine_is_asked_and_the_asker_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    found = running()
    assert found is not None
    assert os.getpid() not in [one.pid for one in found]


def test_where_there_is_no_ps_nobody_can_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(leftovers, "PS", ("no-such-program",))
    assert running() is None
    monkeypatch.setattr(leftovers, "PS", ("false",))
    assert running() is None
