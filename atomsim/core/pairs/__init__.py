"""Which pairs of atoms are declared to collide, and which of them are near."""
