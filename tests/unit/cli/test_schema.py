import argparse
import json
from pathlib import Path

import pytest

from zteleop.cli import schema
from zteleop.errors import ConfigError
from zteleop.messages import MESSAGES

ROOT = Path(__file__).parents[3]


def test_the_committed_schemas_are_fresh_and_none_is_stale() -> None:
    made = schema.files(Path("schemas"))
    committed = {path.relative_to(ROOT) for path in (ROOT / "schemas").rglob("*") if path.is_file()}
    assert committed == made.keys()
    stale = [str(path) for path, text in made.items() if (ROOT / path).read_text() != text]
    assert stale == [], "say: zteleop schema"


def test_every_message_and_the_config_have_a_file() -> None:
    names = {str(path.relative_to("x")) for path in schema.files(Path("x"))}
    assert names == {f"{name}.json" for name in MESSAGES} | {"config.json"}


def test_the_configs_schema_knows_every_table() -> None:
    told = json.loads(schema.files(Path())[Path("config.json")])
    config = told["$defs"]["Config"]
    assert set(config["properties"]) >= {"robot", "driver", "bus", "drive", "speeds", "steps", "drivers"}
    assert config["additionalProperties"] is False
    assert "required" not in config or config["required"] == []


def test_it_writes_every_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    schema.run(argparse.Namespace(folder=tmp_path / "a/b"))
    assert capsys.readouterr().out == f"wrote {len(MESSAGES) + 1} schemas to {tmp_path / 'a/b'}\n"
    for path, content in schema.files(tmp_path / "a/b").items():
        assert path.read_text() == content


def test_where_it_cannot_write_it_says_so(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(ConfigError, match=r"^cannot write .*file.*: "):
        schema.run(argparse.Namespace(folder=tmp_path / "file"))
