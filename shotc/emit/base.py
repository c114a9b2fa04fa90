"""The interface of an emitter: it turns a verified plan into named bytes and never touches the disk."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Protocol, runtime_checkable

from shotc.diag.model import Diagnostic

if TYPE_CHECKING:  # the base install has no numpy
    from shotc.ir.mission import MissionIR
    from shotc.ir.trajectory import VerifiedIR


@dataclass(frozen=True, slots=True)
class Artifact:
    """One output file: its name inside the output folder, and its bytes.

    parts : makes the bytes part by part, for a file that is too large for memory; ``data`` is then empty
    """

    name: str
    data: bytes
    parts: Callable[[], Iterable[bytes]] | None = None

    def chunks(self) -> Iterable[bytes]:
        """Return all bytes of the file, in parts."""
        return (self.data,) if self.parts is None else self.parts()


@dataclass(frozen=True, slots=True)
class Emission:
    """The files of one emitter, with warnings about what the format cannot carry.

    notes : facts for the user, one line each (for example the screen error that a format adds)
    """

    artifacts: tuple[Artifact, ...]
    diagnostics: tuple[Diagnostic, ...] = ()
    notes: tuple[str, ...] = ()


class Emitter(Protocol):
    """Writes one family of output formats (entry-point group ``shotc.emitters``).

    An emitter that loads large libraries may have ``prepare`` as well (see ``Prepares``). It then runs in
    parallel with the others.

    summary : one line for `shotc list emitters`
    api : version of the plugin interface that it was written for (1)
    """

    name: ClassVar[str]
    summary: ClassVar[str]
    api: ClassVar[int]

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return the artifacts of a verified plan."""
        ...


@runtime_checkable
class Prepares(Protocol):
    """An emitter that imports its libraries in a worker process before a plan exists.

    Such emitters run in worker processes, in parallel with the others.
    """

    def prepare(self) -> None:
        """Import what is slow to import.

        It may raise ModuleNotFoundError, which is treated as one from ``emit``.
        """
        ...


def without_origin(mission: MissionIR, emitter: str, code: str, what: str, why: str) -> Diagnostic:
    """Return the warning that files need the origin of a mission, which has none.

    what : the files that are skipped, with their verb; why : they need it
    """
    return Diagnostic(
        code,
        f"{what} skipped: the mission has no world.origin",
        (mission.origins.key(("world",)),),
        (why,),
        f"write `origin: {{lat: ..., lon: ..., alt: ...}}` under `world`, or take `{emitter}` out of `emit`",
    )
