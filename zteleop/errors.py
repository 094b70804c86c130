"""Every error zteleop raises on purpose, each with the builtin a careless `except` would name.

    ZteleopError
    ├── ConfigError  (ValueError)   a setting or an argument cannot be obeyed
    ├── MessageError (ValueError)   bytes are not the message their topic promises
    ├── BusError     (OSError)      the bus cannot be joined, or nobody answers
    └── DeviceError  (OSError)      a chip, bus or terminal is missing, busy or silent

Each message says what was expected, what was found and what to do.
"""


class ZteleopError(Exception):
    """The command line prints these in one sentence, without a traceback."""


class ConfigError(ZteleopError, ValueError):
    """A setting or an argument cannot be obeyed."""


class MessageError(ZteleopError, ValueError):
    """Bytes or fields are not the message their topic promises."""


class BusError(ZteleopError, OSError):
    """The bus cannot be joined, or nobody answers on it."""


class DeviceError(ZteleopError, OSError):
    """A chip, an I2C bus or a terminal is missing, busy or silent."""
