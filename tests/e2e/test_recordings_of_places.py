"""The recordings of missions in real places, read back: what stands there, where, and how the film opens."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from rerun.chunk import RrdReader

from shotc.emit.hillshade import before
from shotc.emit.rerun_log import EMITTER
from shotc.emit.rerun_log.opening import filmed_span, first_stand
from shotc.geom.bernstein import Array
from shotc.geom.surface.occlusion import lines_hidden
from shotc.ir.hiding_surfaces import surfaces_before
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import VerifiedIR
from tests.support.compiled import compiled

pytestmark = pytest.mark.slow

SPECS = Path(__file__).parents[2] / "specs"
MISSIONS = ("terrain/jacksboro-ridge.yaml", "village/church-tower.yaml", "identified/quay-identified.yaml")
POSITIONS, TRANSLATION = "Mesh3D:vertex_positions", "Transform3D:translation"
LENS_DEG = 27.5
"""Half of what the viewer's lens sees, degrees."""


class Recording(NamedTuple):
    """A plan, and its recording: places by entity and component, (N, 3), and the times that are shown."""

    plan: VerifiedIR
    places: dict[tuple[str, str], Array]
    shown: dict[str, Array]

    @property
    def mission(self) -> MissionIR:
        return self.plan.trajectory.keyframes.mission

    def box(self, entity: str) -> Array:
        """The lowest and the highest corner of a mesh, (2, 3)."""
        return box(self.places[entity, POSITIONS])


@pytest.fixture(scope="module", params=MISSIONS)
def recording(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Recording:
    plan = compiled(SPECS / request.param).plan
    assert plan is not None
    path = tmp_path_factory.mktemp("recording") / "mission.rrd"
    path.write_bytes(EMITTER.emit(plan).artifacts[0].data)
    places: dict[tuple[str, str], list[Any]] = {}
    shown: dict[str, list[int]] = {}
    for chunk in RrdReader(path).stream().to_chunks():
        batch, entity = chunk.to_record_batch(), str(chunk.entity_path)
        for name, values in zip(batch.schema.names, batch.columns, strict=True):
            if name == "filmed":
                shown.setdefault(entity, []).extend(values.cast("int64").to_pylist())
            elif name in (POSITIONS, TRANSLATION):
                rows = [place for row in values.to_pylist() if row for place in row]
                places.setdefault((entity, name), []).extend(rows)
    arrays = {key: np.array(found) for key, found in places.items()}
    return Recording(plan, arrays, {entity: np.array(times) / 1e9 for entity, times in shown.items()})


def box(places: Array) -> Array:
    return np.array([places.min(axis=0), places.max(axis=0)])


@pytest.mark.long
def test_what_stands_there_is_in_the_recording_where_it_stands(recording: Recording) -> None:
    mission = recording.mission
    grounds = {} if mission.terrain is None else {"/world/terrain": mission.terrain.ground.surface}
    standing = {f"/world/standing/{mesh.kind}": mesh.surface for mesh in mission.meshes}
    assert grounds or standing
    for entity, surface in (grounds | standing).items():
        np.testing.assert_allclose(recording.box(entity), box(surface.triangles.reshape(-1, 3)), atol=0.01)
    assert (("/world/ground/plane", POSITIONS) in recording.places) is (mission.terrain is None)


@pytest.mark.long
def test_targets_are_where_they_are_filmed(recording: Recording) -> None:
    for target in recording.mission.targets:
        low, high = recording.box(f"/world/targets/{target.name}/body")
        np.testing.assert_allclose(0.5 * (low + high), target.centre, atol=0.01)
        assert high[2] - low[2] == pytest.approx(target.height, abs=0.01)
        assert np.hypot(*(high - low)[:2]) <= 2.0 * np.sqrt(2.0) * target.radius + 0.01


def test_the_camera_flies_the_plan_and_is_shown_from_its_first_filmed_frame_on(recording: Recording) -> None:
    (flight,) = recording.plan.trajectory.drones
    entity = f"/world/cameras/{flight.drone}"
    first, _ = filmed_span(recording.plan)
    assert recording.shown[entity].min() == pytest.approx(first, abs=1e-6)
    assert recording.shown[entity].max() == pytest.approx(flight.curve.end, abs=1e-6)
    flown = flight.curve(np.linspace(flight.curve.start, flight.curve.end, 5000))[:, :3]
    np.testing.assert_allclose(box(recording.places[entity, TRANSLATION]), box(flown), atol=0.05)


def test_the_film_opens_with_the_subject_and_the_camera_in_view(recording: Recording) -> None:
    plan, mission = recording.plan, recording.mission
    (flight,), first, stand = plan.trajectory.drones, filmed_span(plan)[0], first_stand(plan)
    assert stand is not None
    filmed = next(span.target for span in flight.framing if span.start <= first + 1e-6)
    camera, subject = flight.curve(first)[:3], np.array(mission.target(filmed).at(first))
    eye, ahead = np.array(stand.eye), np.subtract(stand.look, stand.eye)
    for place in (camera, subject):
        to = place - eye
        cosine = to @ ahead / np.linalg.norm(to) / np.linalg.norm(ahead)
        assert np.degrees(np.arccos(cosine)) < LENS_DEG
    for _, surface in surfaces_before(mission, filmed):
        assert not lines_hidden(surface, eye[None], subject[None]).any()
    if mission.terrain is not None:
        assert not before(mission.terrain.ground, eye, subject[None]).any()
