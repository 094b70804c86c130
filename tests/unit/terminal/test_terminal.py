import os
import pty
import signal
import termios
from contextlib import suppress
from fcntl import ioctl
from struct import pack

import pyte
import pytest

from zteleop.errors import DeviceError
from zteleop.terminal.terminal import ENTER, LEAVE, Terminal, find_terminal


class Pty:
    """Both ends of a pseudo-terminal and what it shows."""

    def __init__(self) -> None:
        self.master, self.slave = pty.openpty()
        self.screen = pyte.Screen(40, 10)
        self.resize(40, 10)

    def resize(self, columns: int, rows: int) -> None:
        ioctl(self.slave, termios.TIOCSWINSZ, pack("HHHH", rows, columns, 0, 0))

    def output(self) -> str:
        os.set_blocking(self.master, False)
        data = b""
        try:
            while part := os.read(self.master, 65536):
                data += part
        except OSError:
            pass
        return data.decode()

    def show(self) -> list[str]:
        pyte.Stream(self.screen).feed(self.output())
        return [line.rstrip() for line in self.screen.display]

    def modes(self) -> list:
        return termios.tcgetattr(self.slave)

    def close(self) -> None:
        for fd in (self.master, self.slave):
            with suppress(OSError):
                os.close(fd)


@pytest.fixture
def tty(monkeypatch):
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    monkeypatch.delenv("NO_COLOR", raising=False)
    tty = Pty()
    yield tty
    tty.close()


def test_it_leaves_everything_as_found(tty):
    found, handler = tty.modes(), signal.getsignal(signal.SIGCONT)
    with Terminal(tty.slave):
        assert tty.modes() != found
        assert not tty.modes()[3] & (termios.ECHO | termios.ICANON | termios.ISIG)
        assert tty.modes()[1] == found[1]
        assert tty.output() == ENTER
    assert tty.modes() == found
    assert tty.output() == LEAVE
    assert signal.getsignal(signal.SIGCONT) == handler


def test_an_exception_and_a_second_exit_change_nothing(tty):
    found = tty.modes()
    terminal = Terminal(tty.slave)
    with pytest.raises(SystemExit), terminal:
        raise SystemExit(143)
    terminal.__exit__(None, None, None)
    assert tty.modes() == found
    assert tty.output() == ENTER + LEAVE


def test_the_flags_of_the_shared_file_stay(tty):
    with Terminal(tty.slave):
        assert os.get_blocking(tty.slave)


def test_keys_come_as_typed_and_nothing_is_nothing(tty):
    with Terminal(tty.slave) as terminal:
        assert terminal.read() == b""
        os.write(tty.master, b"w\x03\x1a\x1b[A\r")
        assert terminal.read() == b"w\x03\x1a\x1b[A\r"
        assert terminal.read() == b""


def test_keys_typed_before_it_began_do_not_drive(tty):
    os.write(tty.master, b"wwww\n")
    with Terminal(tty.slave) as terminal:
        assert terminal.read() == b""


def test_a_hang_up_is_an_end_and_leaving_it_no_error(tty):
    with Terminal(tty.slave) as terminal:
        os.close(tty.master)
        terminal.draw(["x"])
        with pytest.raises(EOFError):
            terminal.read()


def test_only_lines_that_changed_are_written(tty):
    with Terminal(tty.slave) as terminal:
        terminal.draw(["one", "two", "x" * 40])
        assert tty.show()[:3] == ["one", "two", "x" * 40]
        terminal.draw(["one", "TWO", "x" * 40])
        written = tty.output()
        assert "TWO" in written
        assert "one" not in written
        assert written.startswith("\x1b[?2026h")
        assert written.endswith("\x1b[?2026l")
        terminal.draw(["one", "TWO", "x" * 40])
        assert tty.output() == ""


def test_lines_that_went_are_erased(tty):
    with Terminal(tty.slave) as terminal:
        terminal.draw(["one", "two", "three"])
        terminal.draw(["one"])
        assert tty.show()[:3] == ["one", "", ""]


def test_a_resize_and_a_request_draw_all_anew(tty):
    with Terminal(tty.slave) as terminal:
        terminal.draw(["one"])
        tty.output()
        tty.resize(30, 5)
        assert terminal.size() == (30, 5)
        terminal.draw(["one"])
        assert "one" in tty.output()
        terminal.redraw()
        terminal.draw(["one"])
        assert "one" in tty.output()


def test_more_lines_than_rows_do_not_scroll(tty):
    with Terminal(tty.slave) as terminal:
        terminal.draw([str(row) for row in range(20)])
        assert tty.show() == [str(row) for row in range(10)]


def test_a_terminal_that_takes_nothing_in_skips_frames_and_then_shows_the_newest(tty):
    tty.resize(200, 50)
    tty.screen.resize(50, 200)
    with Terminal(tty.slave) as terminal:
        for frame in range(30):
            terminal.draw([f"{frame:>3} " + "x" * 190] * 50)
        assert terminal._pending
        tty.show()
        for _ in range(3):
            terminal.draw(["newest"])
            shown = tty.show()
        assert shown[:2] == ["newest", ""]


def test_a_dumb_terminal_is_asked_nothing(tty, monkeypatch):
    monkeypatch.setenv("TERM", "dumb")
    with Terminal(tty.slave) as terminal:
        assert not terminal.say("\x1b[c")
        assert tty.output() == ""


def test_what_was_switched_on_is_switched_off_once_before_the_screen_is_left(tty):
    with Terminal(tty.slave) as terminal:
        tty.output()
        assert terminal.switch_on("\x1b[>15u", "\x1b[<u")
        assert not terminal.switch_on("\x1b[>15u", "\x1b[<u")
        assert terminal.say("\x1b[c")
        assert tty.output() == "\x1b[>15u\x1b[c"
    assert tty.output() == "\x1b[<u" + LEAVE


def test_a_question_waits_behind_a_frame_that_is_on_its_way(tty):
    with Terminal(tty.slave) as terminal:
        while not terminal._pending:  # nobody reads at the other end
            terminal.redraw()
            terminal.draw(["y" * 40] * 10)
        terminal.say("\x1b[c")
        shown = tty.output()
        terminal.draw([])
        shown += tty.output()
    assert shown.count("\x1b[c") == 1
    assert "y\x1b[c" not in shown.replace("y" * 40, ""), "no line is cut by it"


def test_after_a_stop_it_is_raw_again_and_says_so(tty):
    with Terminal(tty.slave) as terminal:
        raw = tty.modes()
        termios.tcsetattr(tty.slave, termios.TCSANOW, terminal._saved)
        signal.raise_signal(signal.SIGCONT)
        assert terminal.read() == b""
        assert tty.modes() == raw
        assert terminal.resumed == 1


def test_a_dumb_terminal_gets_one_line_and_no_sequences(tty, monkeypatch):
    monkeypatch.setenv("TERM", "dumb")
    with Terminal(tty.slave) as terminal:
        assert terminal.size() == (40, 1)
        assert not terminal.color
        terminal.draw(["driving", "more"])
        terminal.draw(["idle"])
        terminal.draw(["idle"])
    written = tty.output()
    assert "\x1b" not in written
    assert [part.rstrip() for part in written.split("\r")] == ["", "driving", "idle", "", ""]


def test_without_a_size_it_is_80_by_24(tty):
    tty.resize(0, 0)
    with Terminal(tty.slave) as terminal:
        assert terminal.size() == (80, 24)


def test_a_file_that_is_no_terminal_is_refused(tmp_path):
    with (tmp_path / "file").open("w") as file, pytest.raises(DeviceError, match="run it in a terminal"):
        Terminal(file.fileno())


def test_no_terminal_at_all_is_refused_in_a_sentence(monkeypatch, tmp_path):
    with (tmp_path / "file").open("w") as file:
        monkeypatch.setattr("sys.stdin", file)
        monkeypatch.setattr("sys.stdout", None)
        with pytest.raises(
            DeviceError, match=r"expected a terminal .* found neither .* run it in a terminal"
        ):
            find_terminal()


def test_output_s_terminal_serves_when_input_is_a_pipe(tty, monkeypatch, tmp_path):
    with (tmp_path / "file").open("w") as file, open(tty.slave, "w", closefd=False) as out:
        monkeypatch.setattr("sys.stdin", file)
        monkeypatch.setattr("sys.stdout", out)
        assert find_terminal() == tty.slave


def test_the_screen_is_left_empty_with_the_cursor_at_the_top_before_the_shell_s_is_shown_again():
    screen = pyte.Screen(20, 5)
    stream = pyte.Stream(screen)
    stream.feed(f"{ENTER}a picture\r\n\n\nand more")
    stream.feed(LEAVE.partition("\x1b[?1049l")[0])
    assert "".join(screen.display).strip() == ""
    assert (screen.cursor.x, screen.cursor.y) == (0, 0)
