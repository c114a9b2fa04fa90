"""Twenty shows drawn by seed: each is planned and keeps its separation and limits, or is told why not."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from shotc import api
from shotc.geom.bernstein import Array
from tests.support import show_files
from tests.support.few import few
from tests.support.meshes import box_mesh, obj, ply, sphere_mesh

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("seeded-shows")]

SEEDS, FEW = range(20), range(8)


@cache
def planned(seed: int, folder: Path) -> tuple[bytes | None, list[tuple[str, str]]]:
    """Return the plan file of the show of a seed, and what was said about it."""
    home = folder / str(seed)
    home.mkdir()
    text = yaml.safe_dump(mission(seed, home)).encode()
    options = api.PlanOptions(refiner="none")
    done = api.compile_source(text, "show.yaml", home, options)
    said = [(d.code, " ".join([d.message, *d.notes, d.help or ""])) for d in done.diagnostics]
    if done.plan is None:
        return None, said
    (plan,) = (a for a in api.emit_plan(done.plan, []).artifacts if a.name == "plan.json")
    return plan.data, said


def mission(seed: int, home: Path) -> dict[str, Any]:
    rng = np.random.default_rng(seed)
    across = float(rng.uniform(0.8, 1.4))
    separation = {
        "shape": ["ellipsoid", "cylinder"][seed % 2],
        "horizontal": across,
        "vertical": float(across * rng.uniform(1, 1.8)),
        "margin": float(rng.uniform(0, 0.2)),
    }
    swarm = {
        "count": int(rng.integers(20, 61)),
        "layout": {"grid": {"spacing": 4, "origin": [-12, -12, 0]}},
        "model": "show-drone",
        "separation": separation,
        "rise": 8,
    }
    frames = [picture(rng, home, k, seed % 4 == 0) for k in range(int(rng.integers(2, 4)))]
    shot = {"id": "drawn", "kind": "display", "fleet": "swarm", "frames": frames}
    if rng.random() < 0.5:
        shot |= {"viewpoint": [0, -120, 2], "viewpoint_weight": 0.5}
    return {"shotc": 1, "mission": "seeded", "fleets": {"swarm": swarm}, "shots": [shot]}


def picture(rng: np.random.Generator, home: Path, index: int, moving: bool) -> dict[str, Any]:
    """Return a picture of any kind, the first one of some shows an animation."""
    center = [*rng.uniform(-5, 5, 2).round(2).tolist(), float(rng.uniform(38, 45))]
    size = float(rng.uniform(11, 18))
    heading = f"{rng.uniform(0, 360):.1f} deg"
    kind = "model" if moving and index == 0 else rng.choice(["sphere", "cube", "torus", "text"])
    of: dict[str, dict[str, Any]] = {
        "sphere": {"radius": size},
        "cube": {"size": 2 * size, "heading": heading},
        "torus": {"radius": size, "tube": size / 3, "heading": heading, "tilt": "60 deg"},
        "text": {"text": "HI", "height": 2 * size, "heading": heading},
    }
    if kind == "model":
        frames = int(rng.integers(4, 8))
        of["model"] = animation(rng, home, frames, size) | {"period": float(rng.uniform(1, 2))}
    asked: dict[str, Any] = {str(kind): of[kind] | {"center": center}}
    asked["hold"] = float(rng.choice([0, 2])) if index else 1.0
    asked["fill"] = str(rng.choice(["volume", "surface"])) if kind != "text" else "volume"
    if index and rng.random() < 0.4:
        asked["transition"] = float(rng.uniform(15, 30))
    return asked


def animation(rng: np.random.Generator, home: Path, count: int, size: float) -> dict[str, Any]:
    """Write the frames of a ball that breathes, or of a box that turns, as PLY or OBJ."""
    ball, ending = rng.random() < 0.5, str(rng.choice(["ply", "obj"]))
    for k in range(count):
        data = mesh(ball, k / count, size)
        (home / f"frame{k}.{ending}").write_bytes(ply(data) if ending == "ply" else obj(data))
    return {"files": f"frame*.{ending}", "units": "m"}


def mesh(ball: bool, share: float, size: float) -> Array:
    wave = np.sin(2 * np.pi * share)
    if ball:
        return sphere_mesh(size, 10) * [1 + 0.15 * wave, 1 - 0.15 * wave, 1]
    c, s = np.cos(0.5 * share), np.sin(0.5 * share)
    turned = box_mesh((0, 0, 0), (2 * size, size, 2 * size)) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    return np.asarray(turned)


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the meshes are written."""
    return tmp_path_factory.mktemp("seeded")


@pytest.mark.long
@pytest.mark.parametrize("seed", few(SEEDS, FEW))
def test_a_show_keeps_what_it_asks_or_says_why_not(seed: int, folder: Path) -> None:
    plan, said = planned(seed, folder)
    if plan is None:
        for code, text in said:
            assert code[0] in "DV", text
            assert re.search(r"\d", text), text
        return
    (fleet,) = show_files.flown(plan)
    assert fleet.apart.min() >= 1
    assert max(show_files.beyond_limits(fleet).values()) <= 1 + 1e-9


@pytest.mark.long
def test_most_can_be_planned(folder: Path) -> None:
    refused = {seed: said for seed in SEEDS for plan, said in [planned(seed, folder)] if plan is None}
    assert len(refused) <= 5, refused


@pytest.mark.parametrize("seed", [0, 4])
def test_an_animation_goes_through_its_frames_without_stopping(seed: int, folder: Path) -> None:
    """It is in the air from its first frame to its last, on the clock of its period, and never too near."""
    plan, said = planned(seed, folder)
    assert plan is not None, said
    (fleet,) = show_files.flown(plan)
    frames = [s for s in fleet.flight["shown"] if s["picture"] == 0]
    assert len(frames) == len(list((folder / str(seed)).glob("frame*")))
    starts = np.array([frame["start"] for frame in frames])
    gaps = np.diff(starts)
    # From rest, and to rest, the first and the last step take twice the time of the others.
    assert gaps == pytest.approx([2 * gaps[1], *[gaps[1]] * (len(gaps) - 2), 2 * gaps[1]], abs=1e-3)
    t = np.linspace(starts[0], starts[-1], 2000)
    assert show_files.nearest(fleet.spline(t), fleet.asked["apart"]).min() >= 1
    moved = np.linalg.norm(fleet.spline.derivative()(starts[1:-1]), axis=2).max(axis=1)
    assert moved.min() > 0.02
