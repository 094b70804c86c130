"""What ROS calls a whole number, by the bounds that a field's annotation sets."""

NAMES: dict[tuple[object, object], str] = {
    (-(2**7), 2**7): "int8",
    (-(2**15), 2**15): "int16",
    (-(2**31), 2**31): "int32",
    (0, 2**8): "uint8",
    (0, 2**16): "uint16",
    (0, 2**32): "uint32",
    (0, None): "uint64",
}
"""by the least it may be, and what it stays below"""
