from zteleop import chaos
from zteleop.chaos.operators import OPERATORS


def test_every_fault_has_a_name_of_its_own_and_an_operator_that_there_is() -> None:
    faults = [fault for _, fault in chaos.faults()]
    assert len({fault.name for fault in faults}) == len(faults) > 40
    assert {fault.operator for fault in faults} <= set(OPERATORS)


def test_every_kind_has_faults() -> None:
    assert {kind for kind, _ in chaos.faults()} == set(chaos.KINDS)


def test_whoever_must_rest_has_a_bound() -> None:
    for _, fault in chaos.faults():
        assert fault.bound or fault.then != "rests", fault.name
