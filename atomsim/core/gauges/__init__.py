"""What is measured of chosen atoms: states in, numbers out, to the same bits on every machine."""
