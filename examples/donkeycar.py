"""Steer left and right by pulses, as a Donkeycar program does, until Ctrl-C.

The numbers are counts of 4096 at 60 Hz; channel 0 is the throttle, channel 1 the steering.
"""

import time
from itertools import cycle

from zteleop import Node, PWMController

LEFT, RIGHT, SLOWLY = 330, 420, 380

with Node("donkeycar", robot="archangel") as node:
    throttle, steering = PWMController(0, node=node), PWMController(1, node=node)
    for pulse in cycle([LEFT] * 20 + [RIGHT] * 20):
        throttle.set_pwm(SLOWLY)
        steering.set_pwm(pulse)
        time.sleep(0.05)
