"""Fleets lowered: presets filled in, and layouts as pads."""

from __future__ import annotations

from math import ceil, cos, pi, sin, sqrt

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.limits import Vec3
from shotc.ir.origin import KeyPath
from shotc.ir.show import Apart, Fleet, FleetGroup, group_name, spans
from shotc.kinds.base import bad_file
from shotc.kinds.files import FileFault, read_table
from shotc.kinds.located import in_world
from shotc.passes.resolve.lower.files import Files
from shotc.passes.resolve.lower.world import PadSite, becalmed, beyond_model, limits_of
from shotc.rounding import at_least
from shotc.spec.fleets import CircleSpec, FleetSpec, GridSpec, in_no_group
from shotc.spec.mission import MissionSpec
from shotc.spec.presets import PRESETS

ROWS = (("x", "y", "z"), ("lat", "lon", "height"), ("x", "y"), ("lat", "lon"))
"""Tables of pads; those without a height are of pads that stand on the ground."""


def fleets_of(spec: MissionSpec, site: PadSite, files: Files) -> tuple[tuple[Fleet, ...], list[Diagnostic]]:
    """Return the fleets with readable layouts, and the faults of the others."""
    fleets: list[Fleet] = []
    faults: list[Diagnostic] = []
    for name, written in spec.fleets.items():
        path = ("fleets", name)
        pads = _pads(written, site, files, path)
        if isinstance(pads, Diagnostic):
            faults.append(pads)
            continue
        fleet = _fleet(name, written, spec, pads)
        wrong = [*becalmed("fleet", fleet, spec.world.wind.speed, files.origins), *_touching(fleet, files)]
        wrong += [*beyond_model("fleet", written, path, files.origins), *_not_grouped(written, path, files)]
        faults += wrong
        if not has_errors(wrong):
            fleets += _grouped(fleet, written)
    return tuple(fleets), faults


def _grouped(fleet: Fleet, written: FleetSpec) -> list[Fleet]:
    """Return the fleet; or, if it has groups, the drones in no group, and each group by itself."""
    if not written.groups:
        return [fleet]
    rest = in_no_group(written)
    parts = [("", rest)] if rest else []
    return [_part(fleet, name, numbers) for name, numbers in (*parts, *written.groups.items())]


def _part(fleet: Fleet, name: str, numbers: tuple[int, ...]) -> Fleet:
    return fleet._replace(
        name=group_name(fleet.name, name or None),
        pads=tuple(fleet.pads[number - 1] for number in numbers),
        group=FleetGroup(fleet.name, name, numbers, len(fleet.pads)),
    )


def _not_grouped(written: FleetSpec, path: KeyPath, files: Files) -> list[Diagnostic]:
    """Return the groups that name drones that do not exist, or that are in another group."""
    faults: list[Diagnostic] = []
    group_of: dict[int, str] = {}
    for name, numbers in written.groups.items():
        label = files.origins.value((*path, "groups", name))
        if numbers[-1] > written.count:
            labels = (label, files.origins.value((*path, "count"), "the count"))
            message = f"fleet `{path[-1]}` has {written.count} drones, and no drone {numbers[-1]}"
            valid = [number for number in numbers if number <= written.count]
            help_ = f"{_instead(valid)}, or write `count: {numbers[-1]}`"
            faults.append(Diagnostic("D135", message, labels, help=help_))
        shared = [number for number in numbers if number in group_of]
        if shared:
            other = group_of[shared[0]]
            labels = (label, files.origins.value((*path, "groups", other), "and here"))
            message = f"drone {shared[0]} of fleet `{path[-1]}` is in groups `{other}` and `{name}`"
            notes = (f"they share {len(shared)} drones",) if len(shared) > 1 else ()
            help_ = _instead([number for number in numbers if number not in group_of])
            faults.append(Diagnostic("D134", message, labels, notes, help_))
        group_of |= {number: group_of.get(number, name) for number in numbers}
    return faults


def _instead(numbers: list[int]) -> str:
    """Return what to write for a group; numbers : of drones that may be in it."""
    return f"write `[{spans(numbers)}]`" if numbers else "remove the group"


def _fleet(name: str, written: FleetSpec, spec: MissionSpec, pads: tuple[Vec3, ...]) -> Fleet:
    preset = PRESETS[written.model]
    return Fleet(
        name=name,
        model=written.model,
        pads=pads,
        rise=written.rise,
        returns=written.return_,
        limits=limits_of(preset, written.limits, spec.world.wind.speed),
        radius=written.radius or preset.radius,
        endurance=written.endurance or preset.endurance,
        apart=apart_of(written, spec.rules.separation),
        path=("fleets", name),
    )


def apart_of(written: FleetSpec, separation: float) -> Apart:
    """Return the separation of drones: the fleet's own, or else that of the mission's rules."""
    own = written.separation
    if own is None:
        return Apart("ellipsoid", separation, separation, 0.0)
    return Apart(own.shape, own.horizontal, own.vertical or own.horizontal, own.margin)


def _touching(fleet: Fleet, files: Files) -> list[Diagnostic]:
    """Return the fault of a separation at which the bodies of two drones may touch."""
    least = min(fleet.apart.horizontal, fleet.apart.vertical)
    bodies = 2 * fleet.radius
    if least >= bodies:
        return []
    path = (*fleet.path, "separation")
    label = files.origins.value(path if path in files.origins.keys else ("rules", "separation"))
    if path not in files.origins.keys and ("rules", "separation") not in files.origins.keys:
        label = files.origins.key(fleet.path)
    centres = f"their centres may come within {at_least(least)} m"
    note = f"{centres}, and each body has a radius of {fleet.radius:.2f} m"
    message = f"two drones of {fleet.words} may touch"
    return [Diagnostic("D003", message, (label,), (note,), f"ask for {bodies:.2f} m or more either way")]


def _pads(written: FleetSpec, site: PadSite, files: Files, path: KeyPath) -> tuple[Vec3, ...] | Diagnostic:
    layout = written.layout
    if layout.grid is not None:
        return _grid(layout.grid, written.count, site)
    if layout.circle is not None:
        return _circle(layout.circle, written.count, site)
    assert layout.file is not None
    return _from_file(layout.file, written.count, (site, files), (*path, "layout", "file"))


def _grid(grid: GridSpec, count: int, site: PadSite) -> tuple[Vec3, ...]:
    """Return the pads of a square grid: rows from west to east, each further north."""
    x, y, _ = site.put(grid.origin)
    columns = ceil(sqrt(count))
    plan = ((x + i % columns * grid.spacing, y + i // columns * grid.spacing) for i in range(count))
    return site.over(grid.origin, plan)


def _circle(circle: CircleSpec, count: int, site: PadSite) -> tuple[Vec3, ...]:
    """Return the pads of a circle: evenly spaced, clockwise from its north."""
    x, y, _ = site.put(circle.center)
    turns = (2 * pi * i / count for i in range(count))
    return site.over(circle.center, ((x + circle.radius * sin(a), y + circle.radius * cos(a)) for a in turns))


def _from_file(
    name: str, count: int, where: tuple[PadSite, Files], path: KeyPath
) -> tuple[Vec3, ...] | Diagnostic:
    site, files = where
    data = files.read(name, path)
    if isinstance(data, Diagnostic):
        return data
    table = read_table(data, ROWS)
    if isinstance(table, FileFault):
        return bad_file(files.origins, path, name, table)
    pads = in_world(table, name, files.origin, files.origins, path)
    if isinstance(pads, Diagnostic):
        return pads
    if len(pads) != count:
        labels = (files.origins.value(path), files.origins.value((*path[:-2], "count"), "the count"))
        note = f"`{name}` has {len(pads)} rows, and the fleet has {count} drones"
        help_ = f"write `count: {len(pads)}`, or give {count} rows"
        return Diagnostic("D004", "the layout does not have one row for each drone", labels, (note,), help_)
    if len(table.columns) == 2:
        pads = [(x, y, z + site.ground(x, y)) for x, y, z in pads]
    return tuple(pads)
