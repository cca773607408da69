"""What is wrong with a run, told before it begins, while it goes on, or after it blew up."""
