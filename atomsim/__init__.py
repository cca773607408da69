"""atomsim."""
