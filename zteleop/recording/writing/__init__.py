"""Recordings, written: MCAP files, each with its end, or without it up to where the power failed."""
