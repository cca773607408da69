"""The finished trajectory: one HDF5 file, built from a journal."""
