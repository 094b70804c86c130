"""Bytes of a terminal, both ways: keys in, frames out, and what it can do."""
