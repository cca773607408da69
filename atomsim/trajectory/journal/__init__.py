"""The journal: the append-only file that a run writes its frames to."""
