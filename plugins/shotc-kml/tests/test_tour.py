from __future__ import annotations

from xml.etree import ElementTree

import pytest
from shotc_kml.tour import EMITTER, GX, KML

from tests.support.film_plans import orbit_plan
from tests.support.show_plans import plan as show_plan


def test_the_tour_films_the_shot_at_its_own_pace():
    emission = EMITTER.emit(orbit_plan())
    (artifact,) = emission.artifacts
    assert artifact.name == "cam1.kml"
    root = ElementTree.fromstring(artifact.data)
    durations = [float(e.text) for e in root.iter(f"{{{GX}}}duration")]
    assert sum(durations) == pytest.approx(30.0, abs=1e-4)
    headings = [float(e.text) for e in root.iter(f"{{{KML}}}heading")]
    assert headings[0] == pytest.approx(0.0, abs=1e-3)  # filmed from the south, looking north
    assert headings[-1] == pytest.approx(180.0, abs=1e-3)
    altitude = [float(e.text) for e in root.iter(f"{{{KML}}}altitude")]
    assert altitude[0] == pytest.approx(408 + 20, abs=0.01)


def test_a_mission_without_an_origin_gets_a_warning_and_no_file():
    emission = EMITTER.emit(orbit_plan(origin=False))
    assert emission.artifacts == ()
    assert [d.code for d in emission.diagnostics] == ["E101"]


def test_a_fleet_gets_no_tour_and_a_note_says_so():
    emission = EMITTER.emit(show_plan())
    assert emission.artifacts == ()
    assert "fleets" in emission.notes[0]
