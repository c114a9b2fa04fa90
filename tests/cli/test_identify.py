"""``shotc identify``: a mission with targets and a sheet of pictures, or a fault on its line and nothing."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
import yaml

from shotc import plugins
from tests.cli.conftest import Run
from tests.support.cities import tube
from tests.support.compiled import compiled
from tests.support.meshes import box_mesh, ply
from tests.support.quay_scene import text

pytestmark = pytest.mark.slow

MISSION = """\
shotc: 1
mission: two-towers
world:
  scene: {file: towers.ply, units: m}   # as measured
# Who films.
drones:
  cam: {model: x500, home: [0, -90, 0], camera: {hfov: 70 deg, aspect: "16:9"}}
shots:
  - id: past
    kind: keyframes
    drone: cam
    keyframes:
      - {at: [-20, -70, 15], heading: 0 deg, pitch: 0 deg, box: [0.2, -0.65, 0.6, 0.3]}  # the round one
      - {at: [10, -75, 20], heading: 0 deg, pitch: 0 deg, box: [-0.4, -0.8, 0.0, 0.0]}
  - id: front
    kind: keyframes
    drone: cam
    keyframes:
      - {at: [30, -60, 15], heading: 20 deg, pitch: 0 deg}
      - {at: [40, -60, 15], heading: 10 deg, pitch: 0 deg}
"""
FIRST, SECOND = 13, 14
"""Lines of the keyframes with a box."""
BOX = "box: [0.2, -0.65, 0.6, 0.3]"


@pytest.fixture
def towers(tmp_path: Path) -> Path:
    scene = np.concatenate([tube((0, 0), 6.0, 20.0), box_mesh((60, 0, 15), (12, 12, 30))])
    (tmp_path / "towers.ply").write_bytes(ply(scene))
    path = tmp_path / "towers.yaml"
    path.write_text(MISSION)
    return path


QUAY = Path(__file__).parents[2] / "specs" / "identified"


def test_the_mission_in_specs_is_what_is_made_of_the_one_with_boxes(run: Run, tmp_path: Path) -> None:
    assert (QUAY / "quay.obj").read_text() == text()
    for name in ("quay.obj", "quay.yaml"):
        shutil.copy(QUAY / name, tmp_path)
    done = run("identify", str(tmp_path / "quay.yaml"))
    assert done.code == 0, done.err
    assert (tmp_path / "quay-identified.yaml").read_bytes() == (QUAY / "quay-identified.yaml").read_bytes()


@pytest.mark.long
def test_the_mission_in_specs_plans_without_a_warning() -> None:
    done = compiled(QUAY / "quay-identified.yaml")
    assert done.diagnostics == ()
    assert done.plan is not None


def changed(path: Path, *changes: tuple[str, str]) -> str:
    text = path.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path.write_text(text)
    return str(path)


def left_alone(folder: Path) -> bool:
    """Whether a folder holds what it held, and no more."""
    return sorted(p.name for p in folder.iterdir()) == ["towers.ply", "towers.yaml"]


def test_a_mission_with_targets_and_a_sheet_are_written(run: Run, towers: Path) -> None:
    done = run("identify", str(towers))
    assert done.code == 0, done.err
    assert "target-1  about [0.0, 0.0, 10.0], radius 6.0 m, height 20.0 m" in done.out
    made = towers.with_name("towers-identified.yaml")
    tree = yaml.safe_load(made.read_text())
    x, y, z = tree["targets"]["target-1"]["at"]
    assert (x, y, z) == pytest.approx((0, 0, 10), abs=0.1)
    assert tree["targets"]["target-1"]["radius"] == pytest.approx(6.0, abs=0.1)
    assert [k.get("target") for k in tree["shots"][0]["keyframes"]] == ["target-1", "target-1"]
    kept = [line for line in made.read_text().splitlines() if "target" not in line]
    assert kept == [line for line in MISSION.splitlines() if "box" not in line]
    assert "target: target-1}  # the round one\n" in made.read_text()
    sheet = towers.with_name("towers-identified.png").read_bytes()
    assert sheet.startswith(b"\x89PNG")
    checked = run("check", str(made))
    assert checked.code == 0
    assert "N016" not in checked.err


def test_what_is_there_is_left_unless_it_is_forced(run: Run, towers: Path) -> None:
    other = towers.with_name("done.yaml")
    other.write_text("mine")
    done = run("identify", str(towers), "-o", str(other))
    assert done.code == 2
    assert other.read_text() == "mine"
    assert run("identify", str(towers), "-o", str(other), "--force").code == 0
    assert "target-1" in other.read_text()
    assert other.with_suffix(".png").exists()


def test_a_mission_from_standard_input_goes_to_the_folder(run: Run, towers: Path) -> None:
    done = run("identify", "-", stdin=MISSION.encode())
    assert done.code == 0, done.err
    assert towers.with_name("mission-identified.yaml").exists()


def test_a_guess_has_its_box_written(run: Run, towers: Path) -> None:
    done = run("identify", str(towers), "--guess")
    assert done.code == 0, done.err
    tree = yaml.safe_load(towers.with_name("towers-identified.yaml").read_text())
    for keyframe in tree["shots"][1]["keyframes"]:
        assert keyframe["target"] in tree["targets"]
        u0, v0, u1, v1 = keyframe["box"]
        assert -1 <= u0 < u1 <= 1
        assert -1 <= v0 < v1 <= 1


@pytest.mark.parametrize(
    ("given", "text"),
    [
        (None, "error[N018]: nothing in the picture of the keyframe stands out"),
        ((0.5, 0.2, 0.0, 0.3), "error[P008]: saliency model `mine` of package there"),
        ("box", "error[P008]: saliency model `mine` of package there"),
    ],
)
def test_another_saliency_takes_the_seat(
    run: Run, towers: Path, monkeypatch: pytest.MonkeyPatch, given: object, text: str
) -> None:
    class Mine:
        name, summary, api = "mine", "a model", 1

        def box(self, picture: np.ndarray) -> object:
            assert picture.shape[2] == 3
            assert 0.0 <= picture.min() <= picture.max() <= 1.0
            return given

    seat = plugins.Source(Mine(), "there", "there:Mine")
    monkeypatch.setattr(plugins, "one", lambda _group, _name: seat)
    done = run("identify", str(towers), "--guess")
    assert done.code == 1
    assert text in done.err
    assert left_alone(towers.parent)


def test_an_unknown_saliency_is_a_slip_of_the_command(run: Run, towers: Path) -> None:
    done = run("identify", str(towers), "--guess", "--saliency", "spectral")
    assert done.code == 2
    assert "spectral-residual" in done.err


BAD = {
    "empty": ((BOX, "box: [0.2, -0.65, 0.2, 0.3]"), "S", FIRST, "the box is empty"),
    "swapped": ((BOX, "box: [0.6, -0.65, 0.2, 0.3]"), "S", FIRST, "the corners of the box are swapped"),
    "outside": ((BOX, "box: [0.2, -0.65, 1.6, 0.3]"), "S", FIRST, "1.6"),
    "few": ((BOX, "box: [0.2, -0.65, 0.6]"), "S", FIRST, "4 values"),
    "sky": ((BOX, "box: [-0.9, 0.5, -0.5, 0.9]"), "N018", FIRST, "the box holds only the sky"),
    "ground": ((BOX, "box: [-0.9, -0.9, -0.5, -0.5]"), "N018", FIRST, "the box holds only ground"),
    "little": ((BOX, "box: [0.2, -0.1, 0.285, 0.0]"), "N018", FIRST, "too little of the scene"),
    "without a scene": (
        ("  scene: {file: towers.ply, units: m}   # as measured", "  wind: 0"),
        "N017",
        FIRST,
        "no scene",
    ),
    "inside": (("at: [-20, -70, 15]", "at: [60, 2, 20]"), "G028", FIRST, "inside of `towers`"),
    "a target that is none": ((BOX, f"{BOX}, target: tower"), "N001", FIRST, "unknown target"),
    "two targets": (
        ("heading: 0 deg, pitch: 0 deg, box", "look_at: a, target: b, box"),
        "S",
        FIRST,
        "`target`",
    ),
}


@pytest.mark.parametrize("name", list(BAD))
def test_bad_input_is_told_on_its_line_and_nothing_is_written(run: Run, towers: Path, name: str) -> None:
    change, code, line, text = BAD[name]
    done = run("identify", changed(towers, change))
    assert done.code == 1, done.out
    assert f"error[{code}" in done.err
    assert text in done.err
    assert f"towers.yaml:{line}:" in done.err
    assert left_alone(towers.parent)


def test_a_keyframe_that_is_an_alias_is_told(run: Run, towers: Path) -> None:
    second = MISSION.splitlines()[SECOND - 1]
    path = changed(towers, ("      - {at: [-20", "      - &one {at: [-20"), (second, "      - *one"))
    done = run("identify", path)
    assert done.code == 1
    assert "error[N017]" in done.err
    assert "without an anchor or alias" in done.err
    assert left_alone(towers.parent)


def test_nothing_left_is_told(run: Run, towers: Path) -> None:
    assert run("identify", str(towers)).code == 0
    again = run("identify", str(towers.with_name("towers-identified.yaml")))
    assert again.code == 1
    assert "error[N017]: nothing is left to identify: every box has its target" in again.err
    assert "towers-identified.yaml:" in again.err


def test_a_box_that_means_two_things_is_a_warning_with_the_runner_up(run: Run, towers: Path) -> None:
    scene = np.concatenate([box_mesh((x, 0, 10), (14, 14, 20)) for x in (-8, 8.5)])
    (towers.parent / "towers.ply").write_bytes(ply(scene))
    path = changed(towers, (BOX, "box: [0.1, -0.65, 0.7, 0.3]"))
    done = run("identify", path)
    assert done.code == 0, done.err
    assert "warning[N019]" in done.err
    assert "next is" in done.err


def test_a_camera_inside_of_what_it_means_is_told(run: Run, towers: Path) -> None:
    wide, deep = (80, 2, 12), (2, 80, 12)
    places = (((0, 40, 6), wide), ((0, -40, 6), wide), ((40, 0, 6), deep), ((-40, 0, 6), deep))
    walls = [box_mesh(at, size) for at, size in places]
    bottomless = [w[~(np.abs(w[..., 2]) < 1e-9).all(axis=1)] for w in walls]
    (towers.parent / "towers.ply").write_bytes(ply(np.concatenate(bottomless)))
    path = changed(
        towers,
        ("at: [-20, -70, 15]", "at: [10, 10, 5]"),
        ("heading: 0 deg", "heading: 45 deg"),
        (BOX, "box: [-0.95, -0.4, 0.95, 0.4]"),
    )
    done = run("identify", path)
    assert done.code == 1, done.out
    assert "error[N018]: the camera stands inside of the cylinder" in done.err
    assert left_alone(towers.parent)


def test_a_mission_whose_targets_cannot_be_filmed_is_not_written(run: Run, towers: Path) -> None:
    (towers.parent / "towers.ply").write_bytes(ply(box_mesh((0, 0, 10), (24, 6, 20))))
    path = changed(towers, ("at: [30, -60, 15]", "at: [0, -9, 10]"))
    done = run("identify", path)
    assert done.code == 1
    assert "error[G004]" in done.err
    assert left_alone(towers.parent)


@pytest.mark.slow
def test_what_was_identified_is_planned_and_its_plan_holds(run: Run, towers: Path) -> None:
    towers.write_text(MISSION.partition("  - id: front")[0])
    assert run("identify", str(towers)).code == 0
    made = str(towers.with_name("towers-identified.yaml"))
    done = run("plan", made, "-o", "out", "--refiner", "none", "--emit", "csv")
    assert done.code == 0, done.err
    assert "target-1" in done.out
    verified = run("verify", "out/plan.json", "--against", made)
    assert verified.code == 0, verified.err


def test_a_mission_is_not_planned_while_a_box_has_no_target(run: Run, towers: Path) -> None:
    done = run("plan", str(towers), "-o", "out")
    assert done.code == 1
    assert "error[N016]" in done.err
    assert "run `shotc identify" in done.err
    assert not (towers.parent / "out").exists()
