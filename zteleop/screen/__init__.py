"""What the operator sees: lines of text from what is known, without a clock or a terminal."""
