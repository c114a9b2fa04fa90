"""Targets that keyframes mean, found in a mission's scene (Gebhardt and Hilliges, Sec. 5)."""
