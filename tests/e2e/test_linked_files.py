"""Plans hold the path and the digest of large files: without the file, or with another, nothing is proved."""

from __future__ import annotations

import json

import numpy as np
import pytest

from shotc import api
from shotc.passes.resolve.lower import files as reading
from shotc.planfile.write import plan_bytes
from tests.support.scene_missions import found
from tests.support.terrain_missions import relief, write

pytestmark = pytest.mark.slow

TOWER = "  tower: {at: [120, 60, {above: ground, height: 10}], radius: 2, height: 20}"
SHOT = "kind: static, at: [80, 20, {above: ground, height: 15}], look_at: tower, timing: {duration: 3}"


@pytest.fixture(scope="module")
def planned(tmp_path_factory):
    """A plan over a terrain that is too large for it, the mission's file and the bytes of the plan."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(reading, "MAX_TABLE_BYTES", 1_000)
        path = write(tmp_path_factory.mktemp("mission"), relief(), SHOT, TOWER, "max_height: off")
        options = api.PlanOptions(refiner="none")
        done = api.compile_source(path.read_bytes(), path.as_posix(), path.parent, options)
        assert done.plan is not None, done.diagnostics
        yield path, plan_bytes(done.plan)


def test_a_plan_links_to_what_is_too_large_for_it(planned):
    path, data = planned
    source = json.loads(data)["source"]
    assert source["tables"] == []
    (linked,) = source["linked"]
    assert linked["name"] == "relief.csv"
    assert len(linked["sha256"]) == 64
    assert path.with_name("relief.csv").read_bytes()[:200].decode() not in data.decode()


def test_it_is_verified_with_the_file_in_the_folder_of_its_mission(planned, tmp_path):
    report = api.verify_plan(planned[1], (tmp_path / "plan.json").as_posix())
    assert report.plan is not None, report.diagnostics


def moved(data: bytes) -> bytes:
    """Return a plan whose mission was in a folder that is not there."""
    document = json.loads(data)
    document["source"]["file"] = "no-such-folder/mission.yaml"
    return json.dumps(document).encode()


def test_it_is_verified_with_the_file_beside_the_plan(planned, tmp_path):
    (tmp_path / "relief.csv").write_bytes(planned[0].with_name("relief.csv").read_bytes())
    report = api.verify_plan(moved(planned[1]), (tmp_path / "plan.json").as_posix())
    assert report.plan is not None, report.diagnostics


def test_without_the_file_nothing_is_proved(planned, tmp_path):
    report = api.verify_plan(moved(planned[1]), (tmp_path / "plan.json").as_posix())
    assert report.plan is None
    assert [d.code for d in report.diagnostics] == ["V042", "N011"]
    assert tmp_path.as_posix() in report.diagnostics[1].notes[0]
    assert report.diagnostics[1].labels[0].span.line == 4


def test_with_another_file_nothing_is_proved(planned, tmp_path):
    text = planned[0].with_name("relief.csv").read_text()
    (tmp_path / "relief.csv").write_text(text + "\n")
    report = api.verify_plan(moved(planned[1]), (tmp_path / "plan.json").as_posix())
    assert report.plan is None
    assert [d.code for d in report.diagnostics] == ["V042", "N012"]


def test_a_plan_that_names_another_digest_is_not_believed(planned, tmp_path):
    document = json.loads(planned[1])
    document["source"]["linked"][0]["sha256"] = "0" * 64
    report = api.verify_plan(json.dumps(document).encode(), (tmp_path / "plan.json").as_posix())
    assert report.plan is None
    document["source"]["linked"] = [{"name": "../../etc/hostname", "sha256": "0" * 64}]
    report = api.verify_plan(json.dumps(document).encode(), (tmp_path / "plan.json").as_posix())
    assert report.plan is None


def test_a_plan_is_held_to_the_files_of_the_mission_beside_it(planned, tmp_path):
    path, data = planned
    (tmp_path / "relief.csv").write_text(path.with_name("relief.csv").read_text() + "\n")
    beside = api.MissionFile(path.read_bytes(), "other.yaml", tmp_path)
    report = api.verify_plan(data, "plan.json", beside)
    assert report.plan is None
    assert "V043" in {d.code for d in report.diagnostics}


def test_a_tile_of_one_second_of_arc_is_read(tmp_path):
    heights = np.full((3601, 3601), 510, dtype=">i2")
    (tmp_path / "N46E007.hgt").write_bytes(heights.tobytes())
    mission, faults = found("terrain: {file: N46E007.hgt}", tmp_path)
    assert not faults
    assert mission.ground(0.0, 0.0) == pytest.approx(10.0, abs=0.01)
    assert mission.source.tables == ()
    assert [name for name, _ in mission.source.linked] == ["N46E007.hgt"]
