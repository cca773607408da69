"""How fast atomsim is, beside a plain NumPy loop and other programs that do the same work; no part of the package."""
