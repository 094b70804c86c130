"""Where to go: poses, paths and measures of motion, without a clock; who drives them is a node."""
