"""Scenes and buildings that cannot be used: an error on its line, status 1, nothing written."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.support.command import PLAN, run
from tests.support.meshes import box_mesh, ply
from tests.support.scene_missions import feature, geojson, house, square, text

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("command")]

SCENE, BUILDINGS = "scene: {file: a.ply, units: m}", "buildings: {file: a.geojson}"
CROSSED = [(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)]
BAD = {
    "nan": (SCENE, ply(house()).replace(b"-5 -4 0", b"nan -4 0"), "N009", 5),
    "empty": (SCENE, b"", "N009", 5),
    "millimetres": (SCENE, ply(2000 * house()), "G031", 5),
    "surveyed": (SCENE, ply(house() + np.array([4e5, 5e6, 500.0])), "G033", 5),
    "home inside": (SCENE, ply(box_mesh((0.0, -40.0, 3.0), (10.0, 8.0, 8.0))), "G027", 9),
    "camera inside": (SCENE, ply(box_mesh((40.0, -20.0, 3.0), (10.0, 8.0, 8.0))), "G028", 11),
    "no units": ("scene: {file: a.ply}", ply(house()), "G026", 5),
    "crossed": (BUILDINGS, geojson(feature(CROSSED, building="yes", height=4)), "G034", 5),
    "no height": (BUILDINGS, geojson(feature(square(0, 0, 9), building="yes")), "G035", 5),
    "not geojson": (BUILDINGS, b"[1, 2]", "N009", 5),
    "missing": ("scene: {file: b.ply, units: m}", b"", "N008", 5),
}


@pytest.mark.long
@pytest.mark.parametrize(("world", "data", "code", "line"), BAD.values(), ids=BAD)
def test_it_is_told_where_it_is_written_and_nothing_is(tmp_path, world, data, code, line):
    Path(tmp_path / ("a.geojson" if world == BUILDINGS else "a.ply")).write_bytes(data)
    (tmp_path / "m.yaml").write_text(text(world))
    for command in (("check",), PLAN):
        done = run(*command, "m.yaml", folder=tmp_path)
        assert done.code == 1
        said = done.out + done.err
        assert "Traceback" not in said
        assert f"error[{code}]" in said
        assert f"m.yaml:{line}:" in said
    assert sorted(p.name for p in tmp_path.iterdir()) in (["a.geojson", "m.yaml"], ["a.ply", "m.yaml"])
