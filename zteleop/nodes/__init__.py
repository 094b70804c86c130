"""What runs: one loop per file, and the halves of those that are two."""
