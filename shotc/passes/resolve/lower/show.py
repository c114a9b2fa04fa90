"""Fleets and displays lowered: layouts as pads, and the files that displays draw."""

from shotc.ir.show import Display
from shotc.ir.source import KeptFiles
from shotc.passes.resolve.lower.files import Files
from shotc.passes.resolve.lower.fleets import fleets_of
from shotc.passes.resolve.lower.material import digests, not_kept, read_material
from shotc.passes.resolve.lower.shots import ShowMaterial
from shotc.passes.resolve.lower.world import PadSite
from shotc.spec.load import LoadedMission


def show_material(
    ir: LoadedMission,
    site: PadSite,
    files: Files,
    displays: tuple[Display, ...],
    song: tuple[str, bytes] | None = None,
) -> ShowMaterial:
    """Resolve the fleets, and read the files of their displays; song : (name, bytes)."""
    fleets, wrong = fleets_of(ir.spec, site, files)
    if isinstance(ir.folder, KeptFiles):
        return ShowMaterial(fleets, (), ir.folder.drawn, (*wrong, *not_kept(displays, ir.folder, ir.origins)))
    drawn, missing = read_material(displays, ir.folder, ir.origins)
    material = drawn if song is None else (*drawn, song)
    return ShowMaterial(fleets, material, digests(drawn), (*wrong, *missing))
