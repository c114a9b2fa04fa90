"""Timing s(t) of legs, within limits and deadlines."""
