import subprocess
import sys
from importlib import import_module

import pytest

from zteleop.inputs import INPUTS


@pytest.mark.parametrize("name", INPUTS)
def test_the_table_names_modules_and_says_what_they_do(name):
    module, line = INPUTS[name]
    assert import_module(module).__name__ == module
    assert line
    assert "\n" not in line


def test_importing_inputs_needs_no_unix_and_nothing_slow():
    check = (
        "import sys, zteleop.inputs; unwanted = {'termios', 'tty', 'fcntl', 'curses', 'asyncio', 'logging'};"
        "print(sorted(unwanted & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", check], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
