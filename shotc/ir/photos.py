"""Photos that a shot takes instead of a film. Plain Python."""

from typing import NamedTuple


class Photos(NamedTuple):
    """The interval of photos: in seconds, or in metres of the path; the other one is None."""

    seconds: float | None = None
    metres: float | None = None

    def __str__(self) -> str:
        """Return it in words."""
        return f"every {self.seconds:g} s" if self.seconds is not None else f"every {self.metres:g} m"
