"""Remedies that several readers of files name."""

AGAIN = "export it whole from the program that made it"
"""For a file that breaks off or is damaged."""

CUT = "cut it in two files"
"""For a file that is too large."""


def into(most: int, what: str) -> str:
    """Return the remedy to cut a file that has too many of something."""
    return f"cut it into files of {most} {what} at most"
