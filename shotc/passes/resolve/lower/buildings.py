"""Footprints of buildings, read and checked. Plain Python; numpy makes prisms of them elsewhere."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.geodetic import onto_plane
from shotc.ir.mission import GeoOrigin
from shotc.kinds.base import bad_file
from shotc.kinds.earth import FARTHEST_M, stray
from shotc.kinds.files import FileFault
from shotc.kinds.footprints.geojson import FeatureCollection, described, read_geojson
from shotc.kinds.footprints.houses import BuildingFault, House, Houses, houses_of
from shotc.kinds.footprints.tags import LEVEL_M
from shotc.passes.resolve.lower.files import Files
from shotc.spec.world import BuildingsSpec

BUILDINGS = ("world", "buildings", "file")
_NAMED_BUILDINGS = 3  # buildings that a diagnostic names


class GroundedBuilding(NamedTuple):
    """A building on its ground; z : of the lowest ground below it, None outside of the terrain."""

    house: House
    z: float | None


def read_buildings(
    written: BuildingsSpec, data: bytes, files: Files
) -> tuple[tuple[House, ...], list[Diagnostic]]:
    """Return the buildings of a file, and its faults; no buildings if there is an error among these."""
    label = (files.origins.value(BUILDINGS),)
    origin = files.origin
    if origin is None:
        message = f"`{written.file}` gives latitudes and longitudes, but the mission has no origin"
        help_ = "add `world: {origin: {lat: ..., lon: ..., alt: ...}}`"
        return (), [Diagnostic("G015", message, label, help=help_)]
    footprints = read_geojson(data)
    if isinstance(footprints, FileFault):
        return (), [bad_file(files.origins, BUILDINGS, written.file, footprints)]
    put = onto_plane((origin.lat_deg, origin.lon_deg, origin.alt))
    houses = houses_of(
        footprints.footprints, lambda place: put(place[1], place[0]), FARTHEST_M, written.height
    )
    wrong = list(_errors(written, houses, files))
    if not wrong and not houses.houses:
        wrong = [_without_any(written, footprints, houses, files)]
    return ((), wrong) if wrong else (houses.houses, list(_warnings(written, footprints, houses, files)))


def _errors(written: BuildingsSpec, houses: Houses, files: Files) -> Iterator[Diagnostic]:
    label = (files.origins.value(BUILDINGS),)
    if houses.wrong:
        message = f"{_count(houses.wrong)} of `{written.file}` with an outline or a height that is impossible"
        help_ = "correct their outlines and heights in the file, or take them out of it"
        yield Diagnostic("G034", message, label, _listed(houses.wrong), help_)
    if houses.unknown:
        message = f"{_count(houses.unknown)} of `{written.file}` without a height"
        notes = (f"`height` is not given, nor `building:levels` of {LEVEL_M:g} m", *_listed(houses.unknown))
        help_ = (
            "give them a `height` in the file, or one for all that have none: write `height: 10` beside it"
        )
        yield Diagnostic("G035", message, label, notes, help_)


def _warnings(
    written: BuildingsSpec, footprints: FeatureCollection, houses: Houses, files: Files
) -> Iterator[Diagnostic]:
    label = (files.origins.value(BUILDINGS),)
    if houses.assumed:
        message = f"{_count(houses.assumed)} of `{written.file}` taken to be {written.height:g} m high"
        help_ = "give them a `height` in the file"
        yield Diagnostic("G036", message, label, _listed(houses.assumed), help_)
    left = (
        *described(footprints.others),
        *([f"{houses.passed} polygons of no building"] * (houses.passed > 0)),
    )
    if houses.far:
        left = (*left, f"{len(houses.far)} buildings more than {FARTHEST_M / 1000:.0f} km from the origin")
    if left:
        message = f"some of `{written.file}` is left out: it is no building near the mission"
        yield Diagnostic("G037", message, label, (f"left out: {', '.join(left)}",), _LEFT)
    if houses.uncovered:
        message = f"{_count(houses.uncovered)} of `{written.file}` not covered by the parts in it"
        help_ = "such an outline stays beside its parts where it has a height; complete its parts"
        yield Diagnostic("G037", message, label, _listed(houses.uncovered), help_)


_LEFT = "drones do not keep clear of what is left out; give what stands there `building: yes` and a `height`"


def _without_any(
    written: BuildingsSpec, footprints: FeatureCollection, houses: Houses, files: Files
) -> Diagnostic:
    if houses.far:
        far = houses.far[0]
        origin: GeoOrigin = files.origin or GeoOrigin(0.0, 0.0, 0.0)
        lon, lat = far.ring[0]
        where = stray(origin, lat, lon)
        label = (files.origins.value(BUILDINGS), files.origins.key(("world", "origin"), "the origin"))
        note = f"none of its {len(houses.far)} buildings is nearer than {FARTHEST_M / 1000:.0f} km"
        notes, help_ = ((note,), "") if where is None else ((note, where.note), where.help)
        return Diagnostic("G017", f"`{written.file}` lies somewhere else", label, notes, help_)
    listed = ", ".join(described(footprints.others)) or "no feature"
    wrong = FileFault(f"it holds no footprint: {listed}", None, "export areas, not points or lines")
    return bad_file(files.origins, BUILDINGS, written.file, wrong)


def _count(faults: Sequence[BuildingFault]) -> str:
    return f"{len(faults)} building{'s' * (len(faults) > 1)}"


def _listed(faults: Sequence[BuildingFault]) -> tuple[str, ...]:
    notes = [f"`{f.name}` (feature {f.number}): {f.text}" for f in faults[:_NAMED_BUILDINGS]]
    return (
        (*notes, f"and {len(faults) - _NAMED_BUILDINGS} more")
        if len(faults) > _NAMED_BUILDINGS
        else tuple(notes)
    )
