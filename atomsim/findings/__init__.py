"""What is missing in a scene or went wrong in its run, said with names, lines, numbers and a remedy."""
