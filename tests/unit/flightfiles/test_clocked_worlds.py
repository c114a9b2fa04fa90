"""Shows from files over terrain and beside buildings."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from shotc.geom.earth import of_world
from tests.experiments.planted import FLEET, cruise, show
from tests.support.flight_files import ORIGIN, claims, codes, verified
from tests.support.terrain_missions import cliff
from tests.support.terrain_missions import table as relief_table

TEXT = FLEET.format(zones="", limits="{speed: 8, climb: 3, descent: 3, acceleration: 300, jerk: 90000}")
PADS = ((0.0, 0.0), (4.0, 0.0), (0.0, 4.0), (4.0, 4.0))


@pytest.mark.slow
@pytest.mark.parametrize(("height", "holds"), [(46.0, True), (30.0, False)])
def test_a_fleet_is_held_above_terrain(tmp_path: Path, height: float, holds: bool) -> None:
    # A plain, and from 40 m East on a plateau 40 m above it.
    (tmp_path / "relief.csv").write_text(relief_table(cliff()))
    text = TEXT.replace("alt: 408}", "alt: 408}, terrain: {file: relief.csv}")
    drones = [cruise((x, y, 0.0), height, 4.0, 12.0) for x, y in PADS]
    report = verified(("show.skyc", show(drones)), text=text, folder=tmp_path)
    (clear,) = claims(report, "ground clearance")
    (near,) = claims(report, "distance from terrain")
    assert (clear.holds, near.holds) == (holds, holds)
    assert clear.position is not None
    assert clear.position[0] >= 30.0
    if holds:
        assert 0.0 < height - 40.0 - clear.worst < 0.5  # the body's radius
    else:
        assert clear.worst < -10.0
        assert "V009" in codes(report)


@pytest.mark.parametrize(("height", "holds"), [(20.0, True), (10.0, False)])
def test_a_fleet_is_held_beside_buildings(tmp_path: Path, height: float, holds: bool) -> None:
    # A house 14 m high that stands across the way of the first drones.
    square = np.array([[12.0, -2, 0], [16, -2, 0], [16, 6, 0], [12, 6, 0], [12, -2, 0]])
    ring = [[lon, lat] for lat, lon, _ in of_world(square, ORIGIN).tolist()]
    shape = {"type": "Polygon", "coordinates": [ring]}
    house = {"type": "Feature", "properties": {"height": 14}, "geometry": shape}
    houses = {"type": "FeatureCollection", "features": [house]}
    (tmp_path / "houses.geojson").write_text(json.dumps(houses))
    text = TEXT.replace("alt: 408}", "alt: 408}, buildings: {file: houses.geojson}")
    drones = [cruise((x, y, 0.0), height, 2.0, 8.0) for x, y in PADS]
    report = verified(("show.skyc", show(drones)), text=text, folder=tmp_path)
    (away,) = claims(report, "distance from buildings")
    assert away.holds is holds
    assert ("V052" in codes(report)) is not holds
