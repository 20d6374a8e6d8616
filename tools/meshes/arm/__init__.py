"""The parts of the arm, one file for each kind of part."""
