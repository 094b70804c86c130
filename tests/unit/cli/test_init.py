import io
import subprocess
import sys
from contextlib import redirect_stdout
from importlib import import_module
from importlib.metadata import version
from pathlib import Path

import pytest

import zteleop.cli
from zteleop.cli import GROUPS, SECTIONS, VERBS, file_of, main

FILES = {path.stem for path in Path(zteleop.cli.__file__).parent.glob("*.py")}


@pytest.mark.parametrize("arguments", [[], ["-h"], ["--help"], ["--help", "demo"]])
def test_help_lists_every_verb_with_what_it_does(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 0
    lines = capsys.readouterr().out.splitlines()
    for verb, text in VERBS.items():
        assert any(line.split() == f"{verb} {text}".split() for line in lines)


def test_each_verb_is_one_file_and_each_file_one_verb() -> None:
    assert set(map(file_of, VERBS)) == {name for name in FILES if not name.startswith("_")}


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_has_arguments_and_runs(verb: str) -> None:
    module = import_module(f"zteleop.cli.{file_of(verb)}")
    assert callable(module.add_arguments)
    assert callable(module.run)


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_has_help_of_its_own(verb: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ending:
        main([*verb.split(), "--help"])
    assert ending.value.code == 0
    out = " ".join(capsys.readouterr().out.split())
    assert out.startswith(f"usage: zteleop {verb} ")
    assert VERBS[verb][1:] in out


@pytest.mark.parametrize("flag", ["-V", "--version"])
def test_version_is_the_packages(flag: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([flag]) == 0
    assert capsys.readouterr().out == f"zteleop {version('zteleop')}\n"


@pytest.mark.parametrize(
    ("verb", "words"),
    [
        ("keybord", "zteleop: no verb 'keybord'; did you mean keyboard?"),
        ("ech", "zteleop: no verb 'ech'; did you mean echo?"),
        ("fly", f"zteleop: no verb 'fly'; known: {', '.join(VERBS)}"),
        ("--robot", "zteleop: no verb '--robot'; options stand behind the verb, as in zteleop why --robot "),
        ("--hlep", "zteleop: no verb '--hlep'; did you mean --help?"),
        ("bag", "zteleop: no verb 'bag'; a robot keeps its last minute: zteleop blackbox"),
        ("release", "zteleop: no verb 'release'; zteleop stop --release lets a robot drive again"),
        ("nose.py", "zteleop: no verb 'nose.py'; zteleop run nose.py runs a program"),
        ("\x1b[2J", "zteleop: no verb '\\x1b[2J'; known: "),
        ("", "zteleop: no verb ''; known: "),
    ],
)
def test_an_unknown_verb_is_a_usage_error_with_the_nearest(
    verb: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([verb]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(words)
    assert err.count("\n") == 1


@pytest.mark.parametrize("verb", GROUPS["topic"])
def test_a_verb_may_stand_behind_its_group(verb: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ending:
        main(["topic", verb, "--help"])
    assert ending.value.code == 0
    assert capsys.readouterr().out.startswith(f"usage: zteleop {verb} ")


@pytest.mark.parametrize("group", GROUPS)
def test_a_group_by_itself_tells_what_is_in_it(group: str, capsys: pytest.CaptureFixture[str]) -> None:
    words = [f"{group} {word}" for word in GROUPS[group]]
    assert main([group]) == main([group, "--help"]) == 0
    told = capsys.readouterr().out
    assert all(f"  {verb} " in told for verb in words)
    assert main([group, "fly"]) == 2
    assert capsys.readouterr().err == f"zteleop: no verb '{group} fly'; there are {', '.join(words)}\n"


@pytest.mark.parametrize("verb", VERBS)
def test_an_unknown_option_is_a_usage_error(verb: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ending:
        main([*verb.split(), "--no-such-option"])
    assert ending.value.code == 2
    assert capsys.readouterr().err.startswith(f"usage: zteleop {verb} ")


def test_without_arguments_it_reads_those_of_the_process(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["zteleop", "fly"])
    assert main() == 2


def test_a_program_says_everything_and_does_not_wait_for_pythons_own_end() -> None:
    code = (
        "import atexit, sys, time; from zteleop.cli import program; atexit.register(time.sleep, 60); "
        "sys.stdout.write('kept, '); sys.argv[1:] = {}; program()"
    )
    for words, expected in (["--help"], 0), (["fly"], 2):
        command = [sys.executable, "-c", code.format(words)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=30)
        assert done.returncode == expected
        assert done.stdout.startswith("kept, ")


def test_a_program_whose_reader_left_fails_quietly() -> None:
    code = "import sys; from zteleop.cli import program; sys.argv[1:] = ['--help']; program()"
    with subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as done:
        done.stdout.close()
        assert (done.wait(30), done.stderr.read()) == (1, b"")


def test_help_costs_neither_zenoh_nor_msgspec() -> None:
    code = (
        "import sys; from zteleop.cli import main; assert main(['--help']) == 0; assert main(['fly']) == 2; "
        "print(*{'zenoh', 'msgspec', 'yaml'} & set(sys.modules), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr.splitlines()[1:] == [""]


@pytest.mark.parametrize("argument", ["--help", "--version"])
def test_a_reader_that_left_is_no_error_to_talk_about(argument: str, deaf: io.TextIOWrapper) -> None:
    with redirect_stdout(deaf):
        main([argument])
    deaf.close()


def test_the_list_of_all_verbs_has_headings_and_that_of_a_group_none(
    capsys: pytest.CaptureFixture[str],
) -> None:
    main([])
    lines = capsys.readouterr().out.splitlines()
    headings = [line.rstrip(":") for line in lines if line.endswith(":") and not line.startswith(" ")]
    assert headings == [*SECTIONS.values()]
    assert set(SECTIONS) <= set(VERBS)
    assert [line.split("  ")[1] for line in lines if line.startswith("  ")] == [*VERBS]
    main(["node"])
    assert not [line for line in capsys.readouterr().out.splitlines() if line.endswith(":")]


def test_a_verb_of_a_group_that_was_mistyped_is_asked_about(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["topic", "lst"]) == 2
    assert capsys.readouterr().err == "zteleop: no verb 'topic lst'; did you mean topic list?\n"
