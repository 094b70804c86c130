"""What is kept: journal, black box, and recordings as MCAP files, which every tool for robots opens."""
