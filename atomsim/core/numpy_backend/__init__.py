"""The reference backend: an iteration round as the paper writes it, in whole arrays of NumPy."""
