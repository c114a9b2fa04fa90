"""The show file in Skybrush's own loader, where that can be had: npm package @skybrush/show-format.

Its publisher serves it from a registry of its own. A copy in NODE_PATH is used as it is.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from shotc.emit.skyc import EMITTER
from shotc.geom.fleet_spline import places
from shotc.ir.sampling import light_colors
from tests import sky

PACKAGE, VERSION = "@skybrush/show-format", "5.5.1"
REGISTRY = "https://npm.collmot.com"
SCRIPT = Path(__file__).parents[1] / "skybrush_loader.mjs"


@pytest.fixture(scope="module")
def home(pytestconfig: pytest.Config, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder in which node finds the loader."""
    if shutil.which("node") is None:
        pytest.skip("node is not installed: Skybrush's own loader cannot run")
    for place in filter(None, os.environ.get("NODE_PATH", "").split(os.pathsep)):
        if (Path(place) / PACKAGE).is_dir():
            folder = tmp_path_factory.mktemp("skybrush")
            (folder / "node_modules").symlink_to(Path(place).resolve(), target_is_directory=True)
            return folder
    folder = pytestconfig.rootpath / ".pytest_cache" / "skybrush"
    if not (folder / "node_modules" / PACKAGE).is_dir():
        _install(folder)
    return folder


def _install(folder: Path) -> None:
    if shutil.which("npm") is None:
        pytest.skip(f"npm is not installed, and {PACKAGE} is not in NODE_PATH")
    folder.mkdir(parents=True, exist_ok=True)
    command = ["npm", "install", "--prefix", str(folder), f"--@skybrush:registry={REGISTRY}"]
    command += ["--fetch-retries=0", "--fetch-timeout=20000", "--no-audit", "--no-fund", "--ignore-scripts"]
    try:
        done = subprocess.run(
            [*command, f"{PACKAGE}@{VERSION}"], capture_output=True, text=True, timeout=90, check=False
        )
    except subprocess.TimeoutExpired:
        pytest.skip(f"{REGISTRY} does not answer")
    if done.returncode:
        reason = next((line for line in done.stderr.splitlines() if "npm error" in line), "npm failed")
        pytest.skip(f"{PACKAGE} cannot be installed from {REGISTRY}: {reason}")


def test_skybrush_plays_the_show(home: Path, tmp_path: Path) -> None:
    plan = sky.plan()
    (artifact,) = EMITTER.emit(plan).artifacts
    file = tmp_path / artifact.name
    file.write_bytes(artifact.data)
    script = home / SCRIPT.name  # node looks for packages beside the script
    script.write_bytes(SCRIPT.read_bytes())
    flight = plan.trajectory.fleets[0]
    times = np.arange(0.0, float(flight.breaks[-1]), 0.37)
    command = ["node", str(script), str(file), json.dumps(times.tolist())]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["type"] == "outdoor"
    assert found["cameras"] == 1
    drones = np.array(found["drones"])
    wanted = places(flight.breaks, flight.coef, times)
    wanted = np.stack([wanted[..., 1], -wanted[..., 0], wanted[..., 2]], axis=-1)
    assert np.linalg.norm(drones[..., :3] - wanted, axis=-1).max() < 2e-3
    assert np.abs(255.0 * drones[..., 3:] - light_colors(flight.lights, times)).max() <= 1.5
