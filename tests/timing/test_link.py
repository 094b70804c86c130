"""The short faults of the link once; `python -m faults.link.table` (from tests/) does all, many times."""

import signal
import sys
import time
from pathlib import Path

import pytest
from faults.link.bench import LinkBench
from faults.link.faults import FAULTS, LinkFault
from faults.link.network import DEAD, SOUND, Network, obstacle
from faults.link.trial import attempt
from rig import until
from verdict import excusable, judged

if obstacle():
    pytest.skip(obstacle(), allow_module_level=True)

HICCUP = 0.15
"""s for which a machine must keep processes waiting, so that a robot rests of its own accord"""
LOST = 2.2
"""s after which the place of one who is cut off is free"""
GIVEN_UP = 4.0
"""s after which everybody has given up a link whose other end is silent"""


SHORT = [fault for fault in FAULTS if fault.short]


@pytest.mark.parametrize("fault", SHORT, ids=lambda fault: fault.name.replace(" ", "-"))
def test_whatever_the_link_does_nothing_old_moves_the_robot(tmp_path: Path, fault: LinkFault) -> None:
    outcome = attempt(fault, tmp_path)
    assert not outcome.broken
    if fault.bound is not None:
        assert outcome.seconds is not None
        judged(outcome.seconds, fault.bound, outcome.waited)


def test_whoever_drives_is_not_disturbed_by_another_whose_cable_is_cut(tmp_path: Path) -> None:
    with Network() as network, LinkBench(network, tmp_path) as bench:
        command = [sys.executable, "-m", "faults.link.sender", bench.rig.robot, bench.rig.endpoint]
        other = bench.rig.start(network.robot, command, bench.rig.environment)
        other.says("heard")
        with excusable(HICCUP, bench.rig):
            network.set(DEAD)
            cut = time.monotonic()
            until(lambda: time.monotonic() > cut + LOST, "a place that is free")
            other.signal(signal.SIGUSR1)  # whoever waited begins anew
            until(lambda: bench.witness.moved(cut + LOST), "motion")
            taken = time.monotonic()
            until(lambda: time.monotonic() > cut + GIVEN_UP, "the end of the first operator's link")
            network.set(SOUND)
            bench.is_heard_again()
            assert not [at - cut for at in bench.witness.rests if at > taken]
        assert not bench.witness.stale
