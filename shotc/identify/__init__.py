"""Identifies the targets that keyframes mean in a mission's scene (Gebhardt and Hilliges, Sec. 5)."""
