"""Short missions that raise codes of readers, with the files that they name, also as the help wants them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from tests.support.meshes import obj, ply, stl
from tests.support.scene_missions import feature, geojson, house, square


class Case(NamedTuple):
    """A mission that raises a code.

    files : name to content; mended : those of them that the help says to change, changed
    """

    code: str
    mission: str
    files: dict[str, bytes]
    mended: dict[str, bytes] | None = None


VILLAGE = """\
shotc: 1
mission: village
world:
  origin: {lat: 46.68, lon: 7.68, alt: 500}
  WORLD
targets:
  statue: {at: [60, 0], radius: 1, height: 4}
drones:
  cam: {model: x500, home: [0, -40]}
shots:
  - {id: look, kind: static, drone: cam, at: [40, -20, {above: ground, height: 6}], look_at: statue}
"""
RUN = """\
shotc: 1
mission: run
targets:
  runner: {track: {TRACK}, radius: 0.4, height: 1.8}
drones:
  cam: {model: x500, home: [0, -30, 0]}
shots:
  - {id: side, kind: lateral, drone: cam, target: runner, side: left, distance: 8, altitude: 4,
     timing: {TIMING}}
"""
WAY = """\
shotc: 1
mission: way
drones:
  cam: {model: x500, home: [0, -30, 0]}
shots:
  - {id: along, kind: follow-path, drone: cam, file: way.csv, heading: along}
"""
SHOW = """\
shotc: 1
mission: show
fleets:
  swarm: {count: 4, layout: LAYOUT, separation: 2}
shots:
  - {id: shapes, kind: display, fleet: swarm, frames: [{PICTURE, hold: 4}]}
"""
GRID, BALL = "{grid: {spacing: 4, origin: [0, 0, 0]}}", "sphere: {center: [0, 0, 40], radius: 12}"
TURNED: Array = house()[..., [0, 2, 1]] * [1.0, -1.0, 1.0]
"""A house that hangs upside down where y points up."""
LYING: Array = house()[..., [0, 2, 1]] * [1.0, 1.0, -1.0]
FAR: Array = house() + np.array([400_000.0, 5_170_000.0, 500.0])
NEARER: Array = house() + np.array([40_000.0, 5000.0, 500.0])
KNOT = [(0.0, 0.0), (9.0, 9.0), (9.0, 0.0), (0.0, 9.0)]
STAR = '<svg viewBox="0 0 9 9"><path d="M0 0 L9 0 L9 9 Z" fill="none" stroke="red"/>{}</svg>'


def beside(
    code: str, world: str, data: bytes, mended: bytes | None = None, statue: str | None = None
) -> Case:
    """Return a mission with a file that its world names; statue : what is filmed, unless it stands there."""
    name = world.partition("{file: ")[2].partition(",")[0].rstrip("}")
    text = VILLAGE.replace("WORLD", world)
    if statue is not None:
        text = text.replace("{at: [60, 0], radius: 1, height: 4}", statue)
    return Case(code, text, {name: data}, None if mended is None else {name: mended})


def after(
    code: str, rows: str, mended: str | None = None, timing: str = "{duration: 5}", track: str = ""
) -> Case:
    """Return a mission of a runner on a recorded track."""
    text = RUN.replace("{TRACK}", f"{{file: run.csv{track}}}").replace("{TIMING}", timing)
    changed = None if mended is None else {"run.csv": mended.encode()}
    return Case(code, text, {"run.csv": rows.encode()}, changed)


def along(rows: str, mended: str) -> Case:
    return Case("N009", WAY, {"way.csv": rows.encode()}, {"way.csv": mended.encode()})


def show(code: str, layout: str, picture: str, *files: tuple[str, str], mended: str | None = None) -> Case:
    text = SHOW.replace("LAYOUT", layout).replace("PICTURE", picture)
    changed = None if mended is None else {files[0][0]: mended.encode()}
    return Case(code, text, {name: data.encode() for name, data in files}, changed)


def built(*squares: tuple[float, dict[str, str | int]]) -> bytes:
    """Return footprints of 9 m beside the origin; squares : how far north each is, and its properties."""
    return geojson(*(feature(square(60, y, 9), **tags) for y, tags in squares))


def posts(header: str = "x,y,z", reach: int = 300, z: float = 0.0) -> bytes:
    rows = (f"{x},{y},{z:g}\n" for x in (-reach, reach) for y in (-reach, reach))
    return f"{header}\n{''.join(rows)}".encode()


def shaking() -> str:
    """Return rows of a course of 2 m/s that stray to and fro."""
    return "t,x,y,z\n" + "".join(
        f"{t / 5},{0.4 * t + (t * 7 % 5 - 2) / 5},{(t * 3 % 7 - 3) / 8},0.9\n" for t in range(300)
    )


BARN: dict[str, str | int] = {"name": "Barn", "building": "yes", "height": 4}
ONE, OTHER = BARN | {"@id": "way/1"}, BARN | {"@id": "way/2"}
BARE: dict[str, str | int] = {"building": "yes"}
CLOSE = "{at: [20, 0], radius: 1, height: 4}"
BUILDINGS = "buildings: {file: h.geojson}"
PLY, MODEL = ply(house()).decode(), "model: {files: house.ply, center: [0, 0, 40]"
GAP = "".join(f"{t},{2 * t},0,0.9\n" for t in (*range(20), *range(40, 70)))
ROWS = "t,x,y,z\n0,0,0,0.9\n20,40,0,0.9\n"
CASES = [
    beside("G026", "scene: {file: house.ply}", ply(house())),
    beside("G030", "scene: {file: house.ply, units: m}", ply(1000 * house())),
    beside("G031", "scene: {file: house.ply, units: mm}", ply(house())),
    beside("G031", "scene: {file: house.ply, units: m}", ply(5000 * house())),
    beside("G031", "scene: {file: house.ply, units: m, at: [20000, 0, 0]}", ply(house())),
    beside("G031", "scene: {file: house.obj, units: m}", obj(NEARER)),
    beside("G031", "scene: {file: house.obj, units: m, at: [0, 9, 0]}", obj(FAR), obj(house())),
    beside("G032", "scene: {file: house.ply, units: m}", ply(TURNED)),
    beside("G032", "scene: {file: house.ply, units: m}", ply(LYING)),
    beside("G033", "scene: {file: house.ply, units: m}", ply(FAR), ply(house())),
    beside("G033", "scene: {file: house.stl, units: m}", stl(FAR), stl(house())),
    beside("G051", "scene: {file: house.ply, units: m, at: [0, 0, -40]}", ply(house())),
    beside("G027", "scene: {file: house.ply, units: m, at: [0, -40, 0]}", ply(house())),
    beside("G028", "scene: {file: house.ply, units: m, at: [40, -20, 0]}", ply(house())),
    beside("G034", BUILDINGS, geojson(feature(KNOT, **BARN)), built((0, BARN))),
    beside("G035", BUILDINGS, built((0, BARE)), built((0, BARN))),
    beside("G035", BUILDINGS, built((0, BARE))),
    beside("G036", "buildings: {file: h.geojson, height: 6}", built((0, BARE)), built((0, BARN))),
    beside("G037", BUILDINGS, built((0, BARN), (40, {"landuse": "grass"})), built((0, BARN), (40, BARN))),
    beside("G048", BUILDINGS, built((0, BARN)), statue="{building: Bern}"),
    beside("G049", BUILDINGS, built((0, ONE), (40, OTHER)), statue="{building: Barn}"),
    beside("G046", "terrain: {file: hill.csv}", posts(reach=50), posts()),
    beside("G025", "terrain: {file: hill.csv}", posts(reach=30), posts(), statue=CLOSE),
    beside("N009", "terrain: {file: hill.csv}", posts("x,y"), posts("x,y,z")),
    beside("N009", "terrain: {file: hill.csv}", posts().replace(b",", b";"), posts()),
    after("M022", f"t,x,y,z\n{GAP}", "t,x,y,z\n" + "".join(f"{t},{2 * t},0,0.9\n" for t in range(70))),
    after("M021", "t,x,y,z\n0,0,0,0.9\n1,90,0,0.9\n3,10,0,0.9\n6,20,0,0.9\n9,29,0,0.9\n"),
    after("G047", shaking(), timing="{start: 20, duration: 15}"),
    after("M004", ROWS, timing="{start: 15, duration: 15}"),
    after("N009", f"{ROWS}10,20,0,0.9\n", f"{ROWS}30,60,0,0.9\n"),
    after("N009", "t,x,y,z\n0,0,0,0.9\n20,40 m,0,0.9\n", ROWS),
    after("N009", "time,east,north,up\n0,0,0,0.9\n20,40,0,0.9\n", ROWS),
    after("N009", "", ROWS),
    along("x,y,z\n0,0,8\n0,0,8\n", "x,y,z\n0,0,8\n9,0,8\n"),
    along("x,y\n0,0\n10,0\n", "x,y,z\n0,0,8\n9,0,8\n"),
    along("x,y,z\n0,0,8\n10,0\n", "x,y,z\n0,0,8\n9,0,8\n"),
    along("x,y,z\n0;0;8\n10;0;8\n", "x,y,z\n0,0,8\n9,0,8\n"),
    show("D004", "{file: pads.csv}", BALL, ("pads.csv", "x,y,z\n0,0,0\n4,0,0\n8,0,0\n")),
    show("D025", GRID, f"{MODEL}}}", ("house.ply", PLY)),
    show("D010", GRID, "model: {files: h*.ply, units: m}", ("h1.ply", PLY), ("h2.ply", PLY)),
    show("D022", GRID, "svg: {file: star.svg, center: [0, 0, 40], height: 20}",
        ("star.svg", STAR.format("<script>1</script>")), mended=STAR.format("")),
]  # fmt: skip
