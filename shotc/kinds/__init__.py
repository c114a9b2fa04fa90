"""Shot kinds, one module each."""
