"""What mission files do with a lens is judged: the focus that they carry, the zoom that they cannot."""

from __future__ import annotations

import json

import pytest

from tests.support.second_opinion.case import Case
from tests.support.second_opinion.compiled import case_of
from tests.support.second_opinion.reflight import reflights

pytestmark = pytest.mark.slow

LENSES = """\
shotc: 1
mission: lenses
world: {origin: {lat: 47.3769, lon: 8.5417, alt: 408}}
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones:
  sharp: {model: x500, home: [0, -70, 0], camera: {sensor: 36 mm, focal_length: 50 mm, aperture: f/2}}
  zooming: {model: x500, home: [40, 0, 0]}
shots:
  - {id: in, kind: dolly, drone: sharp, target: mast, azimuth: 180 deg, distance: [60, 36], altitude: 8}
  - id: look
    kind: keyframes
    drone: zooming
    target: mast
    require: {in_frame: 50 %}
    keyframes: [{at: [30, -10, 12], look_at: mast}, {at: [30, 10, 12], look_at: mast, hfov: 60 deg}]
output: {rate: 10}
"""


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Case:
    path = tmp_path_factory.mktemp("second") / "lenses.yaml"
    path.write_text(LENSES, encoding="utf-8")
    return case_of(path, "none")


def rules(case: Case, **files: bytes) -> set[str]:
    named = {f"{name}.plan": data for name, data in files.items()}
    return {found.rule for found in reflights(Case(case.mission, {**case.files, **named}, case.notes))}


def test_a_file_focuses_and_a_file_without_its_promised_zoom_is_not_written(case: Case) -> None:
    assert "sharp.plan" in case.files
    assert "zooming.plan" not in case.files
    assert rules(case) == set()


def test_a_focus_elsewhere_is_seen(case: Case) -> None:
    file = json.loads(case.files["sharp.plan"])
    focuses = [item for item in file["mission"]["items"] if item["command"] == 532]
    focuses[-1]["params"][1] = 12.0
    assert "focus in the film" in rules(case, sharp=json.dumps(file).encode())


def test_a_file_without_its_promised_zoom_is_seen(case: Case) -> None:
    assert "file without its promised zoom" in rules(case, zooming=case.files["sharp.plan"])
