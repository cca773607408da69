"""What is found out of the frames of a run: measures as series, and what happened."""
