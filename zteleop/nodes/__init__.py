"""What runs: one loop per file."""
