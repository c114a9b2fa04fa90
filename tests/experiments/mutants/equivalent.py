"""What is told of a mutant that no test can kill: it does what the source does, or it does not matter."""

from __future__ import annotations

from typing import NamedTuple


class Equivalent(NamedTuple):
    """A mutant that is no fault.

    source : the text of its line; change : as the report writes it; reason : why no test can kill it
    nth : of the same ones in its file, from 0; None for all of them
    """

    path: str
    source: str
    change: str
    reason: str
    nth: int | None = None

    @property
    def key(self) -> tuple[str, str, str]:
        """What the mutant is known by."""
        return self.path, self.source, self.change
