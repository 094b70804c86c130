"""What is kept: recordings as MCAP files, which every tool for robots opens."""
