"""The interface of passes: a named value that lowers one IR to the next, or returns diagnostics."""

from collections.abc import Callable
from typing import TYPE_CHECKING, ClassVar, Generic, NamedTuple, Protocol, TypeVar

from shotc.diag.model import Diagnostic

if TYPE_CHECKING:
    from shotc.ir.path import PathIR

Value_co = TypeVar("Value_co", covariant=True)


def silent(_message: str) -> None:
    """Ignore a progress message."""


class PassContext(NamedTuple):
    """The inputs of every pass besides its IR.

    seed : for random numbers; progress : called with a short text during long work
    headings : method of ``solvers.headings.METHODS`` that chooses the turns of a camera without a target;
        None means its ``DEFAULT``
    """

    seed: int = 0
    progress: Callable[[str], None] = silent
    headings: str | None = None


class Outcome(NamedTuple, Generic[Value_co]):
    """The result of a pass: the next IR, or None after an error, and its diagnostics."""

    value: Value_co | None
    diagnostics: tuple[Diagnostic, ...] = ()


class Refiner(Protocol):
    """The interface of refiners (entry-point group ``shotc.refiners``)."""

    name: ClassVar[str]
    summary: ClassVar[str]
    api: ClassVar[int]

    def refine(self, path: "PathIR", ctx: PassContext) -> Outcome["PathIR"]:
        """Return a better path, or the errors that prevent it.

        An error that labels the key of a shot concerns that shot alone. Return it together with a path that
        keeps the shot's convex leg; then the other shots stay refined if the mission allows it.
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
