"""Where a robot of chaos lives: a name, a folder and surroundings that nobody else has."""

import os
import secrets
import shutil
import tempfile
from pathlib import Path

SABOTAGE = Path(__file__).with_name("sabotage")


class Place:
    """One of a kind; `chip` is the file of the robot's chip, where it is to be another than its own."""

    def __init__(self, simulated: bool, chip: str = "") -> None:
        self.robot = f"chaos-{secrets.token_hex(2)}"
        self.folder = Path(tempfile.mkdtemp(prefix="zt-"))
        self.address = self.folder / "door"
        own = f"{self.folder}/zteleop/{self.robot}.pca9685" if simulated else ""
        self.chip = chip or own
        self.order = self.folder / "order"
        """Where a sabotaged process finds what it is to do."""

    @property
    def environment(self) -> dict[str, str]:
        """What processes that live here find around them, beside what this one has."""
        path = filter(None, (str(SABOTAGE), os.environ.get("PYTHONPATH")))
        return os.environ | {
            "XDG_STATE_HOME": f"{self.folder}/state",
            "XDG_RUNTIME_DIR": str(self.folder),
            "TMPDIR": str(self.folder),  # who is killed leaves its folder
            "PYTHONPATH": os.pathsep.join(path),
            "ZTELEOP_CHAOS_ORDER": str(self.order),
        }

    def leave(self) -> None:
        """Remove the folder."""
        shutil.rmtree(self.folder, ignore_errors=True)  # a black box may still be writing
