"""Helps about the files and pictures of a show: each is done, and goals are placed without the fault."""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
import pytest
from PIL import Image

from shotc.api import PlanOptions, compile_source
from shotc.diag.model import Diagnostic, Severity
from shotc.diag.registry import severity_of
from tests.support.meshes import ply, sphere_mesh
from tests.support.scene_missions import house

pytestmark = pytest.mark.slow

SHOW = """\
shotc: 1
mission: show
fleets:
  swarm: {count: 40, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}, separation: 1}
shots:
  - {id: shapes, kind: display, fleet: swarm, frames: [{PICTURE, hold: 4}]}
"""


class Case(NamedTuple):
    """A picture that raises a code, with files beside it, and how the help wants both.

    picture : of the mission; mended : the picture as the help says
    files   : name to content; changed : those of them that the help says to change, changed
    """

    code: str
    picture: str
    said: str
    mended: str
    files: dict[str, bytes]
    changed: Mapping[str, bytes] = MappingProxyType({})


def cloud(count: int) -> bytes:
    """Return a point cloud of points on a sphere of 10 m."""
    turn = np.pi * (1.0 + 5.0**0.5) * np.arange(count)
    up = 1.0 - 2.0 * (np.arange(count) + 0.5) / count
    flat = np.sqrt(1.0 - up**2)
    points = 10.0 * np.stack([flat * np.cos(turn), flat * np.sin(turn), up], axis=1)
    rows = "".join(f"{x:.4f} {y:.4f} {z:.4f}\n" for x, y, z in points)
    head = f"ply\nformat ascii 1.0\nelement vertex {count}\nproperty float x\nproperty float y\n"
    return f"{head}property float z\nend_header\n{rows}".encode()


def image(wide: int) -> bytes:
    stream = BytesIO()
    Image.new("1", (wide, wide), 1).save(stream, "PNG")
    return stream.getvalue()


MODEL = "model: {files: m.ply, units: m, center: [0, 0, 40], height: 16}, fill: surface"
IN_UNITS = "model: {files: m.ply, units: UNITS, center: [0, 0, 40]}, fill: surface"
BALL, OPEN = ply(10.0 * sphere_mesh(1.0, 8)), ply(house()[1:])
DRAWN = "svg: {file: s.svg, center: [0, 0, 40], height: 20}"
STAR = b'<svg viewBox="0 0 9 9"><path d="M0 0 L9 0 L9 9 Z" fill="red"/></svg>'
EMPTY = b'<svg viewBox="0 0 9 9"><path d="M0 0" fill="red"/></svg>'
LINE = b'<svg viewBox="0 0 9 9"><path d="M0 0 L9 0" stroke="red"/></svg>'
SPHERE = "sphere: {center: [0, 0, 40], radius: 12}"
LIT = f"{SPHERE}, effects: [{{image: {{file: i.png}}}}]"
FLAT = ply(house() * [1.0, 1.0, 0.0])
CASES = [
    Case("D050", MODEL, "", MODEL, {"m.ply": b"ply\n"}, {"m.ply": BALL}),
    Case("D050", MODEL, "leave `height` out", MODEL.replace(", height: 16", ""), {"m.ply": FLAT}),
    Case("D051", MODEL.replace("surface", "volume"), "use `fill: surface`", MODEL, {"m.ply": OPEN}),
    Case("D051", MODEL.replace("surface", "volume"), "close the mesh", MODEL.replace("surface", "volume"),
        {"m.ply": OPEN}, {"m.ply": ply(house())}),
    Case("D052", IN_UNITS.replace("UNITS", "m"), "write `units: mm`", IN_UNITS.replace("UNITS", "mm"),
        {"m.ply": ply(10_000.0 * sphere_mesh(1.0, 8))}),
    Case("D052", IN_UNITS.replace("UNITS", "m"), "such as `height: 20`", MODEL.replace("16", "20"),
        {"m.ply": ply(10_000.0 * sphere_mesh(1.0, 8))}),
    Case("D054", DRAWN, "draw", DRAWN, {"s.svg": EMPTY}, {"s.svg": STAR}),
    Case("D054", DRAWN, "draw something taller", DRAWN, {"s.svg": LINE}, {"s.svg": STAR}),
    Case("D061", MODEL.replace(", fill: surface", ""), "give a denser cloud",
        MODEL.replace(", fill: surface", ""), {"m.ply": cloud(30)}, {"m.ply": cloud(400)}),
    Case("D100", LIT, "", LIT, {"i.png": b"png"}, {"i.png": image(2)}),
    Case("D101", LIT, "", LIT, {"i.png": image(9000)}, {"i.png": image(2)}),
]  # fmt: skip


def found(picture: str, folder: Path) -> list[Diagnostic]:
    text = SHOW.replace("PICTURE", picture)
    options = PlanOptions(stop_after="place-goals")
    return list(compile_source(text.encode(), "m.yaml", folder, options).diagnostics)


@pytest.mark.long
@pytest.mark.parametrize("case", CASES, ids=[f"{case.code}-{i}" for i, case in enumerate(CASES)])
def test_what_a_help_proposes_does_when_it_is_written(case: Case, tmp_path: Path) -> None:
    for name, data in case.files.items():
        (tmp_path / name).write_bytes(data)
    (fault,) = (d for d in found(case.picture, tmp_path) if d.code == case.code)
    assert fault.help
    assert case.said in fault.help
    for name, data in case.changed.items():
        (tmp_path / name).write_bytes(data)
    after = found(case.mended, tmp_path)
    assert [d for d in after if d.code == case.code or severity_of(d) is Severity.ERROR] == []
