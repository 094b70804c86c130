"""How messages travel: the only zenoh, and the one clock."""
