"""``shotc import``: results on standard output, the rest on standard error, and all or nothing in a file."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml

from tests.cli.conftest import Run
from tests.support.camera_files import GOOD

XML = """\
<mission eventRef="GO">
 <targetTypes><targetType><name>TARGET_RUNNER</name></targetType></targetTypes>
 <shootingActionSequences><shootingActionSequence><shootingActions>
  <shootingAction shootingActionTemplateRef="LATERAL">
   <duration>20</duration><formationSpeed>5,4</formationSpeed>
   <RTTrajectory>
    <RTTrajectoryPoint><x>0</x><y>0</y><altitude>-1.0</altitude><time>0</time></RTTrajectoryPoint>
    <RTTrajectoryPoint><x>30</x><y>0</y><altitude>-1.0</altitude><time>20</time></RTTrajectoryPoint>
   </RTTrajectory>
   <shootingRoles><shootingRole>
    <name>LATERAL</name><framingTypeName>FRAMING_TYPE_LS</framingTypeName>
    <shootingTypeName>RULE_OF_THIRDS</shootingTypeName>
    <params>{"y_0": {"value": -8}, "z_0": {"value": 3}}</params>
   </shootingRole></shootingRoles>
  </shootingAction>
 </shootingActions></shootingActionSequence></shootingActionSequences>
</mission>
"""


@pytest.fixture
def karting(tmp_path: Path) -> Path:
    path = tmp_path / "karting.xml"
    path.write_text(XML)
    return path


def test_the_mission_goes_to_standard_output_and_what_is_assumed_beside_it(run: Run, karting: Path) -> None:
    done = run("import", "multidrone", str(karting))
    assert done.code == 0
    assert yaml.safe_load(done.out)["shots"][0]["side"] == "right"
    assert "warning[I004]: `5,4` has a decimal comma" in done.err
    assert "karting.xml:5:27" in done.err
    assert "imported 1 drone, 1 shot; 6 assumptions" in done.err


def test_a_file_is_written_that_check_accepts(run: Run, karting: Path, tmp_path: Path) -> None:
    written = tmp_path / "new" / "karting.yaml"
    done = run("import", "multidrone", str(karting), "-o", str(written))
    assert (done.code, done.out) == (0, "")
    assert f"next: shotc check {written}" in done.err
    assert run("check", str(written)).code == 0


def test_standard_input_is_read(run: Run) -> None:
    done = run("import", "multidrone", "-", stdin=XML.encode())
    assert done.code == 0
    assert "<stdin>:5:27" in done.err


def test_strict_writes_nothing(run: Run, karting: Path, tmp_path: Path) -> None:
    written = tmp_path / "karting.yaml"
    done = run("import", "multidrone", str(karting), "--strict", "-o", str(written))
    assert (done.code, done.out) == (1, "")
    assert "error[I005]" in done.err
    assert not written.exists()


def test_what_cannot_be_flown_is_refused_and_the_old_file_kept(
    run: Run, karting: Path, tmp_path: Path
) -> None:
    written = tmp_path / "karting.yaml"
    written.write_text("old")
    karting.write_text(XML.replace("<x>30</x>", "<x>700</x>"))
    done = run("import", "multidrone", str(karting), "-o", str(written))
    assert (done.code, done.out) == (1, "")
    assert "error[I006]" in done.err
    assert written.read_text() == "old"


@pytest.mark.parametrize("name", ["none.xml", ".", "a\0b", "x" * 300])
def test_a_file_that_cannot_be_read_is_told(run: Run, name: str) -> None:
    done = run("import", "multidrone", name)
    assert (done.code, done.out) == (1, "")
    assert "error[I001]" in done.err


@pytest.mark.parametrize("text", ["", "shotc: 1", "<!DOCTYPE a><mission/>", "<kml/>", "<mission/>"])
def test_what_is_no_mission_is_refused(run: Run, karting: Path, text: str) -> None:
    karting.write_text(text)
    done = run("import", "multidrone", str(karting))
    assert (done.code, done.out) == (1, "")
    assert "error[I00" in done.err


@pytest.mark.parametrize("format", GOOD)
def test_files_of_cameras_are_written_as_missions_that_check_accepts(
    run: Run, tmp_path: Path, format: str
) -> None:
    (tmp_path / "cameras").write_bytes(GOOD[format])
    done = run("import", format, "cameras", "-o", "mission.yaml")
    assert (done.code, done.out) == (0, "")
    assert re.search(r"imported 1 drone, 1 shot, \d keyframes of \d cameras; \d assumption", done.err)
    assert run("check", "mission.yaml").code == 0


def test_options_of_an_import_are_what_the_importer_is_told(run: Run, tmp_path: Path) -> None:
    (tmp_path / "tour.kml").write_bytes(GOOD["kml"])
    given = yaml.safe_load(run("import", "kml", "tour.kml", "--ground", "408", "--every", "--times").out)
    assert given["world"]["origin"]["alt"] == 408
    assert [k["time"] for k in given["shots"][0]["keyframes"]] == [0.0, 6.0, 11.0]
    (tmp_path / "camera.csv").write_bytes(GOOD["blender-camera"])
    slow = yaml.safe_load(run("import", "blender-camera", "camera.csv", "--fps", "4").out)
    assert slow["shots"][0]["timing"]["duration"] == 6.0
    assert run("import", "blender-camera", "camera.csv", "--fps", "0").code == 2
    assert run("import", "kml", "tour.kml", "--fps", "24").code == 2
    assert run("import", "kml", "tour.kml", "--ground", "nan").code == 2


def test_a_tour_of_100_megabytes_is_refused_at_its_beginning(run: Run, tmp_path: Path) -> None:
    with (tmp_path / "tour.kml").open("wb") as file:
        file.truncate(100_000_000)
    done = run("import", "kml", "tour.kml")
    assert (done.code, done.out) == (1, "")
    assert "larger than 4 MB" in done.err


def test_an_unknown_format_is_a_matter_of_usage(run: Run, karting: Path) -> None:
    done = run("import", "nuke", str(karting))
    assert done.code == 2
    assert "there are: multidrone, kml" in " ".join(done.err.split())
