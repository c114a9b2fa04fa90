"""Owners of obstacles that no mission writes down."""

from shotc.ir.owners import Owner


def owner(text: str) -> Owner:
    """Return the owner that a plan would name so, with no place in a mission."""
    kind, _, name = text.partition(" ")
    return Owner(kind, name, ())  # type: ignore[arg-type]
