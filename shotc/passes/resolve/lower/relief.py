"""Terrain from an elevation model. This module needs numpy, so it is imported where a mission names one."""

from __future__ import annotations

from collections.abc import Iterable

from shotc.diag.model import Diagnostic
from shotc.geom.terrain.posts import Posts, TerrainFault
from shotc.geom.terrain.relief import PlanRectangle, Relief, relief_of
from shotc.ir.limits import Vec3
from shotc.ir.mission import GeoOrigin
from shotc.ir.terrain import Terrain
from shotc.kinds.base import bad_file
from shotc.kinds.elevation.reader import read_elevation
from shotc.kinds.files import FileFault
from shotc.passes.resolve.lower.files import Files
from shotc.spec.world import TerrainSpec


def relief(
    written: TerrainSpec, data: bytes, about: tuple[Iterable[Vec3], float], files: Files
) -> Terrain | Diagnostic:
    """Return the ground of an elevation model, or its fault.

    about : places of the mission in W, the first drone's home first, and how far around them it is read,
        metres
    files : for the origin, and the lines of faults
    """
    name, path = written.file, ("world", "terrain", "file")

    def fault(fault_of_terrain: TerrainFault) -> Diagnostic:
        return bad_file(
            files.origins,
            path,
            name,
            FileFault(fault_of_terrain.message, fault_of_terrain.line, fault_of_terrain.help),
        )

    posts = read_elevation(name, data, written.epsg)
    if not isinstance(posts, Posts):
        return fault(posts)
    every, beyond = list(about[0]) or [(0.0, 0.0, 0.0)], about[1]  # layouts from files are read after it
    box = PlanRectangle(
        (min(p[0] for p in every) - beyond, min(p[1] for p in every) - beyond),
        (max(p[0] for p in every) + beyond, max(p[1] for p in every) + beyond),
    )
    geo = files.origin
    origin = None if geo is None else (geo.lat_deg, geo.lon_deg, geo.alt)
    ground = relief_of(posts, box, origin, _offset(written, posts, geo))
    if not isinstance(ground, Relief):
        return fault(ground)
    terrain = Terrain(ground.ground, name, of_earth=posts.system is not None)
    if written.datum != "home":
        return terrain
    home = every[0]
    under = terrain.height(home[0], home[1])
    if under is None:
        return fault(TerrainFault("empty", "it has no ground at the first drone's home, which is its datum"))
    return terrain.raised(home[2] - under)


def _offset(written: TerrainSpec, posts: Posts, origin: GeoOrigin | None) -> float:
    """Return the offset that makes heights count like the origin's altitude, metres.

    Posts in W count from its origin; on the earth a height above the plane z = 0 is one above the origin.
    """
    on_earth = posts.system is not None and origin is not None
    return origin.alt if on_earth and origin is not None and written.datum == "origin" else 0.0
