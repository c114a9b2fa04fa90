"""The vehicle of `shotc simulate` beside RotorPy's: how far both stray from one plan, in the same wind.

python -m tests.experiments.vehicles [MISSION ...]
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import numpy as np

from shotc.api import PlanOptions, compile_source
from shotc.geom.bernstein import Array
from shotc.ir.trajectory import TrajectoryIR
from shotc.simulation.conditions import Conditions
from shotc.simulation.flight import fly_all
from shotc.simulation.wind import WindField
from shotc.simulation.world import World

WINDS = (WindField(), WindField(3.0, 0.0, 1.0), WindField(5.0, 1.0, 1.0))
PAGE = Path(__file__).parents[2] / "shotc" / "docs" / "flying.md"


def strays(ir: TrajectoryIR, wind: WindField, vehicle: str) -> Array:
    """Return how far the first drone of a plan is from it, every 20 ms, of two runs, metres."""
    world = World.of(ir, Conditions(vehicle=vehicle, wind=wind), (0, 1))  # type: ignore[arg-type]
    flown = fly_all(world, ir.drones[:1])[0]
    return np.asarray(
        np.linalg.norm(flown.position - ir.drones[0].curve(flown.times)[:, None, :3], axis=2).ravel()
    )


def main(names: list[str]) -> None:
    """Print a row for every mission, wind and vehicle."""
    (page,) = re.findall(r"```yaml\n(# walker.yaml\n.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    texts = [("flying.md", page.encode(), None)] if not names else []
    texts += [(name, Path(name).read_bytes(), Path(name).parent) for name in names]
    for name, text, folder in texts:
        plan = compile_source(text, name, folder, PlanOptions()).plan
        assert plan is not None, name
        for wind in WINDS:
            for vehicle in ("lag", "rotorpy"):
                off = strays(plan.trajectory, wind, vehicle)
                sizes = float(np.sqrt(np.mean(off**2))), float(np.quantile(off, 0.95)), float(off.max())
                row = "  ".join(f"{size:.3f}" for size in sizes)
                print(
                    f"{name}  wind {wind.speed:g} gusts {wind.gusts:g}  {vehicle:8}  rms, 95 %, max  {row} m"
                )


if __name__ == "__main__":
    main(sys.argv[1:])
