import argparse
from pathlib import Path

from zteleop.config import Config
from zteleop.errors import ConfigError
from zteleop.interfaces.schema import text
from zteleop.messages import MESSAGES

EXAMPLES = (
    "zteleop schema",
    "zteleop schema elsewhere",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", nargs="?", type=Path, default=Path("schemas"), help="default: schemas")


def run(arguments: argparse.Namespace) -> None:
    try:
        for path, content in files(arguments.folder).items():
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content)
    except OSError as error:
        raise ConfigError(f"cannot write {error.filename}: {error.strerror}") from None
    print(f"wrote {len(MESSAGES) + 1} schemas to {arguments.folder}")


def files(folder: Path) -> dict[Path, str]:
    """Return every schema file and its text."""
    messages = {folder / f"{name}.json": text(kind, name) for name, kind in MESSAGES.items()}
    return messages | {folder / "config.json": text(Config, "config.toml")}
