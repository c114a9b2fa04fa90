"""Seeded faults in the source, and whether the tests notice: `make mutants`."""
