"""The diagnostic codes, one module per family."""
