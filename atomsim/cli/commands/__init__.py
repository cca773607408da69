"""The commands, a file each: what they take, what they print and how they end."""
