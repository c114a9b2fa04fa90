"""What a pass is: a value with a name that turns one IR into the next, or says why it cannot."""

from collections.abc import Callable
from typing import TYPE_CHECKING, ClassVar, Generic, NamedTuple, Protocol, TypeVar

from shotc.diag.model import Diagnostic

if TYPE_CHECKING:
    from shotc.ir.path import PathIR

Value_co = TypeVar("Value_co", covariant=True)


def silent(_message: str) -> None:
    """Report progress to nobody."""


class PassContext(NamedTuple):
    """What every pass may read besides its input.

    seed : for anything random; progress : call with a short text on long work
    headings : how the turns of a camera that follows nothing are chosen, of ``solvers.headings.METHODS``;
        None means its ``DEFAULT``
    """

    seed: int = 0
    progress: Callable[[str], None] = silent
    headings: str | None = None


class Outcome(NamedTuple, Generic[Value_co]):
    """What a pass gives: the next IR, or None where an error stopped it, and its diagnostics."""

    value: Value_co | None
    diagnostics: tuple[Diagnostic, ...] = ()


class Refiner(Protocol):
    """What sits in the refiner seat (entry-point group ``shotc.refiners``)."""

    name: ClassVar[str]
    summary: ClassVar[str]
    api: ClassVar[int]

    def refine(self, path: "PathIR", ctx: PassContext) -> Outcome["PathIR"]:
        """Return a better path, or errors that say why there is none.

        An error that labels the key of a shot is about that shot alone: return it together with a path
        that has the shot's convex leg, and the other shots stay refined where the mission allows it.
        """
        ...


if TYPE_CHECKING:
    In_contra = TypeVar("In_contra", contravariant=True)
    Out_co = TypeVar("Out_co", covariant=True)

    class Pass(Protocol[In_contra, Out_co]):
        """A lowering from one IR to the next. User faults are diagnostics; an exception is a bug."""

        name: ClassVar[str]

        def run(self, ir: In_contra, ctx: PassContext) -> Outcome[Out_co]:
            """Lower ``ir``."""
            ...
