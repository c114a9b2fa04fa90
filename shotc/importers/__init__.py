"""Missions of other tools made into missions of ours: text in, text out, and what had to be assumed."""
