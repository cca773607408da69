"""The version, written here and nowhere else; knows nothing."""

__version__ = "0.1.0"
