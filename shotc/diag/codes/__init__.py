"""The diagnostic codes, one module a family."""
