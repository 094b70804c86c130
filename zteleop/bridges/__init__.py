"""Who else listens: a bridge brings the bus to somebody who does not speak it."""
