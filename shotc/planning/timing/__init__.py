"""Timing s(t): legs over time, within limits, by deadlines."""
