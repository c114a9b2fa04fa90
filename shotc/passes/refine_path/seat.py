"""The refiner that a plan uses, and where it comes from; and the refiner that does nothing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.ir.passes import Outcome, PassContext, Refiner
from shotc.ir.path import PathIR


@dataclass(frozen=True, slots=True)
class KeepPath:
    """The refiner ``none``: it returns the convex path."""

    name: ClassVar[str] = "none"
    summary: ClassVar[str] = "fly the convex path as it is"
    api: ClassVar[int] = 1

    def refine(self, path: PathIR, ctx: PassContext) -> Outcome[PathIR]:
        """Return ``path``."""
        del ctx
        return Outcome(path)


REFINER = KeepPath()


@dataclass(frozen=True, slots=True)
class Unusable:
    """A refiner that could not be loaded; ``faults`` say why."""

    name: str
    faults: tuple[Diagnostic, ...]
    summary: ClassVar[str] = "cannot be loaded"
    api: ClassVar[int] = 1

    def refine(self, path: PathIR, ctx: PassContext) -> Outcome[PathIR]:
        """Return no path, and the faults."""
        del path, ctx
        return Outcome(None, self.faults)


class Seat(NamedTuple):
    """A refiner and where it comes from.

    package : the distribution that registers it
    reference : module:attribute, by which another process finds it; empty where there is none
    """

    refiner: Refiner | Unusable = REFINER
    package: str = "shotc"
    reference: str = ""

    @property
    def named(self) -> str:
        """The refiner's name in messages, with its package."""
        return f"refiner `{self.refiner.name}` of package {self.package}"
