"""Other programs that compute the same rounds in float64, each in its own file and imported only if it is installed."""
