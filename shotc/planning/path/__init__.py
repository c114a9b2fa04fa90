"""Paths q(s): the position, the camera and the body along legs that no clock binds."""
