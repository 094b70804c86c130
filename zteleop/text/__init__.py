"""How messages and values are written, and read back."""
