"""The kernel's PWM files in memory, with its refusals: what tests write to instead of /sys/class/pwm."""

import errno

CHANNELS = 2


def refuse(number: int) -> OSError:
    return OSError(number, "refused")


class FakeKernel:
    """One chip of two channels, as Linux 6 shows it."""

    def __init__(self, chip: str = "/sys/class/pwm/pwmchip0") -> None:
        self.chip = chip
        self.files: dict[str, str] = {f"{chip}/export": "", f"{chip}/npwm": str(CHANNELS)}
        self.log: list[tuple[str, str]] = []
        """What was written, and where, below the chip."""
        self.failing: list[OSError] = []
        """What the next accesses meet."""
        self.locked = 0
        """How often it is looked whether a file may be written until udev has been there."""
        self.broken: set[str] = set()
        """Files that always fail."""

    def exists(self, path: str) -> bool:
        return path in self.files

    def writable(self, path: str) -> bool:
        self.locked -= self.locked > 0
        return path in self.files and not self.locked

    def read(self, path: str) -> str:
        self._meet(path)
        return self.files[path]

    def write(self, path: str, text: str) -> None:
        self._meet(path)
        if self.locked and "/pwm" in path.removeprefix(self.chip):
            raise refuse(errno.EACCES)
        place = path.removeprefix(f"{self.chip}/")
        if place == "export":
            self._export(int(text))
        else:
            self._apply(path, text)
        self.log.append((place, text))

    def power_cycle(self) -> None:
        """Forget every channel, as when the module is loaded anew."""
        self.files = {
            path: text for path, text in self.files.items() if "/pwm0/" not in path and "/pwm1/" not in path
        }

    def width_ns(self, channel: int) -> int | None:
        """Return what leaves the pin."""
        at = f"{self.chip}/pwm{channel}"
        return int(self.files[f"{at}/duty_cycle"]) if self.files.get(f"{at}/enable") == "1" else None

    def _meet(self, path: str) -> None:
        if self.failing:
            raise self.failing.pop(0)
        if path in self.broken:
            raise refuse(errno.EIO)
        if path not in self.files:
            raise refuse(errno.ENOENT)

    def _export(self, channel: int) -> None:
        at = f"{self.chip}/pwm{channel}"
        if channel >= CHANNELS:
            raise refuse(errno.ENODEV)
        if f"{at}/enable" in self.files:
            raise refuse(errno.EBUSY)
        new = {"period": "0", "duty_cycle": "0", "enable": "0", "polarity": "normal"}
        self.files |= {f"{at}/{name}": text for name, text in new.items()}

    def _apply(self, path: str, text: str) -> None:
        """Refuse what the kernel does: no period, a pulse longer than it, a polarity while it is enabled."""
        folder, _, name = path.rpartition("/")
        state = {key: self.files[f"{folder}/{key}"] for key in ("period", "duty_cycle")} | {name: text}
        if int(state["period"]) == 0 or int(state["duty_cycle"]) > int(state["period"]):
            raise refuse(errno.EINVAL)
        if name == "polarity" and self.files[f"{folder}/enable"] == "1":
            raise refuse(errno.EBUSY)
        self.files[path] = text
