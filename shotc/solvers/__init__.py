"""Adapters to the solvers: arrays in, results out."""
