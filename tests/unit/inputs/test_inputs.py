import subprocess
import sys


def test_importing_inputs_needs_no_unix_and_nothing_slow():
    check = (
        "import sys, zteleop.inputs; unwanted = {'termios', 'tty', 'fcntl', 'curses', 'asyncio', 'logging'};"
        "print(sorted(unwanted & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", check], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
