"""A drive and the senders around it, on one clock; `now` is what the test says."""

from zteleop.control.drive import Drive, Step
from zteleop.control.evidence import Evidence
from zteleop.control.gate import Refusal
from zteleop.control.proof import Prover
from zteleop.control.settings import DriveSettings
from zteleop.messages import Beat, Confirmed, Pwm, Stop, Twist

TICK_US = 4.08
NEUTRAL = {0: 1509.6, 1: 1530.0}
FORWARD = Twist.planar(0.5)
REST = Twist.planar()


class Robot:
    def __init__(self, drive_settings: DriveSettings | None = None) -> None:
        self.now, self.epoch = 100.0, 1
        self.drive = Drive(drive_settings or DriveSettings(), TICK_US, self.epoch, self.now)
        self.now += 0.02
        self.provers = {name: Prover(number) for number, name in enumerate("abc", 1)}

    def wait(self, seconds: float) -> Step:
        for _ in range(round(seconds * 50)):
            self.now += 0.02
            step = self.drive.step(self.now)
        return step

    def say(
        self,
        command: Twist | Pwm,
        sender: str = "a",
        source: str = "keyboard",
        act: bool = True,
        age: float = 0.0,
    ) -> Refusal | None:
        """Say a command that was `age` s on its way, from the robot's beat back to the robot."""
        prover, beat = self.provers[sender], Beat(self.epoch, self.now - age, self.drive.admission.gate.floor)
        if act:
            prover.act(beat)
        moving = command not in (REST, Pwm(375, 370))
        return self.drive.receive(source, command, prover.prove(beat, moving, self.now), self.now)

    def hold(
        self,
        command: Twist | Pwm,
        seconds: float,
        act: bool = True,
        sender: str = "a",
        source: str = "keyboard",
        age: float = 0.0,
    ) -> Step:
        """Say a command about 17 times a second, as somebody who holds a key."""
        for _ in range(round(seconds * 20)):
            self.say(command, sender, source, act, age)
            step = self.wait(0.06)
        return step

    def stop(self, identity: int) -> bool:
        return self.drive.admission.stop(Stop(engaged=True, id=identity, by="ann", why=""), self.now)

    def release(self, identity: int) -> bool:
        return self.drive.admission.stop(Stop(engaged=False, id=identity, by="ann", why=""), self.now)

    def step(self) -> Step:
        return self.drive.step(self.now)

    def chip(self, step: Step, confirmed: Confirmed = "", age: float = 0.0) -> Evidence:
        """Return what is known of a chip that takes everything."""
        return Evidence(step.pulse_us, self.now - age, confirmed)


def moves(step: Step) -> bool:
    return step.pulse_us != NEUTRAL
