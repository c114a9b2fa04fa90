"""Photos that are taken in place of a film. Plain Python."""

from typing import NamedTuple


class Photos(NamedTuple):
    """How far they are apart: seconds, or metres on the way; the other one is None."""

    seconds: float | None = None
    metres: float | None = None

    def __str__(self) -> str:
        """Return it in words."""
        return f"every {self.seconds:g} s" if self.seconds is not None else f"every {self.metres:g} m"
