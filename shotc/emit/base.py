"""What an emitter is: verified plan in, named bytes out. It never touches the disk."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Protocol, runtime_checkable

from shotc.diag.model import Diagnostic

if TYPE_CHECKING:  # the base install has no numpy
    from shotc.ir.trajectory import VerifiedIR


@dataclass(frozen=True, slots=True)
class Artifact:
    """One output file: its name inside the output folder, and its bytes.

    parts : makes the bytes one part after another, of a file that is too large to be held; ``data`` is then
    empty
    """

    name: str
    data: bytes
    parts: Callable[[], Iterable[bytes]] | None = None

    def chunks(self) -> Iterable[bytes]:
        """Return all of its bytes, in parts."""
        return (self.data,) if self.parts is None else self.parts()


@dataclass(frozen=True, slots=True)
class Emission:
    """What one emitter made, with warnings about what the format could not carry.

    notes : facts for the user, one line each (e.g. the screen error that a format adds)
    """

    artifacts: tuple[Artifact, ...]
    diagnostics: tuple[Diagnostic, ...] = ()
    notes: tuple[str, ...] = ()


class Emitter(Protocol):
    """Writes one family of output formats (entry-point group ``shotc.emitters``).

    summary : one line for `shotc list emitters`; api : the plugin api it was written against (1)
    One that loads large libraries may have ``prepare``, too (see ``Prepares``), to run beside the others.
    """

    name: ClassVar[str]
    summary: ClassVar[str]
    api: ClassVar[int]

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return the artifacts of a verified plan."""
        ...


@runtime_checkable
class Prepares(Protocol):
    """What an emitter may do beside: load what ``emit`` needs, in a process that has no plan yet.

    Such emitters run beside the others, in worker processes.
    """

    def prepare(self) -> None:
        """Import what is slow to import; ModuleNotFoundError is as good as in ``emit``."""
        ...
