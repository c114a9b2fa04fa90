"""Fleets and displays lowered: layouts as pads, and the files that displays draw."""

from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.ir.show import Display, Fleet
from shotc.ir.source import KeptFiles
from shotc.passes.resolve.lower.files import Files
from shotc.passes.resolve.lower.fleets import PadSite, fleets_of
from shotc.passes.resolve.lower.material import Material, digests, not_kept, read_material
from shotc.spec.load import LoadedMission


class ShowMaterial(NamedTuple):
    """Fleets with readable layouts, the files that displays draw, and the faults of the others.

    files : (name, bytes), the song among them
    drawn : (name, SHA-256) of the drawn files
    """

    fleets: tuple[Fleet, ...] = ()
    files: Material = ()
    drawn: tuple[tuple[str, str], ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()


def shown(
    ir: LoadedMission,
    site: PadSite,
    files: Files,
    displays: tuple[Display, ...],
    song: tuple[str, bytes] | None = None,
) -> ShowMaterial:
    """Resolve the fleets, and read the files of their displays; song : (name, bytes)."""
    if not ir.spec.fleets:
        return ShowMaterial()
    fleets, wrong = fleets_of(ir.spec, site, files)
    if isinstance(ir.folder, KeptFiles):
        return ShowMaterial(fleets, (), ir.folder.drawn, (*wrong, *not_kept(displays, ir.folder, ir.origins)))
    drawn, missing = read_material(displays, ir.folder, ir.origins)
    material = drawn if song is None else (*drawn, song)
    return ShowMaterial(fleets, material, digests(drawn), (*wrong, *missing))
