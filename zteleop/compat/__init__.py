"""Whose programs run: the shapes of other libraries, on top of the bus."""
