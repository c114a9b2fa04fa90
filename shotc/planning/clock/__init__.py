"""Motions q(t): shots of what moves, and the way to and from them on the mission's clock."""
