"""Recordings, read: MCAP files that may be cut off, or lie, one or a folder of them."""
