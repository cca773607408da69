"""Scenes: the language, the loader with its messages, the schema; knows no atoms, no arrays, no files but scenes."""
