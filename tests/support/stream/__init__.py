"""Autopilots for tests: MAVLink at the far end of a loopback, and a clock that runs as it is asked to."""
