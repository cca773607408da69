"""Models laid out as flat arrays for compiled kernels; NumPy alone, so that any such backend can use them."""
