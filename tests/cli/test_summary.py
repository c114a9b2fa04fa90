"""What `plan` prints at its end: whose every number is."""

from __future__ import annotations

from pathlib import Path

from shotc.cli.centred import centred
from shotc.cli.summary import WIDTH_CHARACTERS, shot_rows, summary
from shotc.geom.track import Track
from shotc.ir.path import PathDeviation
from shotc.ir.trajectory import Claim, VerifiedIR
from shotc.source.file import WHOLE_FILE
from shotc.spec.compositions import COMPOSITIONS
from tests.support.film_plans import SPEED, orbit_plan
from tests.support.records import replace
from tests.support.two_target_plans import claims, pair_plan


def facts(plan: VerifiedIR, name: str) -> list[str]:
    """The facts of one name, each on one line."""
    found: list[str] = []
    for line in summary(plan, [Path("out/plan.json")], []).splitlines():
        assert len(line) <= WIDTH_CHARACTERS
        if line[2:12].strip():
            found.append(line[2:])
        elif line.strip():
            found[-1] += " " + line.strip()
    return [line[len(name) :].strip() for line in found if line.startswith(f"{name} ")]


def test_a_shot_of_several_targets_has_a_row_for_each() -> None:
    assert shot_rows(pair_plan()) == [
        ("shot", "kind", "from", "lasts", "target", "in frame", "screen error", "size"),
        ("half", "keyframes", "0:22.0", "30.00 s", "tower", "100 %", "0.031", "0.60 to 0.70"),
        ("", "", "", "", "mast", "75 %", "0.024", "0.05 to 0.06"),
    ]


def test_a_shot_of_one_target_has_a_row_that_needs_no_name() -> None:
    plan = orbit_plan()
    one = VerifiedIR(plan.trajectory, claims("tower", 0.5, 0.1, (0.2, 0.3)))
    head = ("shot", "kind", "from", "lasts", "target in frame", "screen error", "size")
    start = ("half", "keyframes", "0:22.0", "30.00 s")
    assert shot_rows(one) == [head, (*start, "50 %", "0.100", "0.20 to 0.30")]
    assert shot_rows(plan) == [head, (*start, "-", "-", "-")]


def test_what_is_covered_is_told_where_anything_is() -> None:
    plan = orbit_plan()
    (first, *rest) = claims("tower", 0.5, 0.1, (0.2, 0.3))
    seen = replace(first, constraint="tower visible", worst=0.62, unit="of its outline")
    head, row = shot_rows(VerifiedIR(plan.trajectory, (first, *rest, seen)))
    assert (head[5], row[5]) == ("visible", "62 %")
    free = replace(seen, worst=1.0)
    assert "visible" not in shot_rows(VerifiedIR(plan.trajectory, (first, *rest, free)))[0]


def test_how_far_smoothing_moves_a_track_is_told() -> None:
    plan = orbit_plan()
    keyframes = plan.trajectory.keyframes
    track = Track((0.0, 1.0), ((0.0, 0.0, 1.0), (1.0, 0.0, 1.0)), smoothed=0.4213)
    (tower,) = keyframes.mission.targets
    mission = replace(keyframes.mission, targets=(replace(tower, track=track),))
    moved = replace(plan, trajectory=replace(plan.trajectory, keyframes=replace(keyframes, mission=mission)))
    assert facts(plan, "smoothed") == []
    assert facts(moved, "smoothed") == ["the track of tower lies up to 0.43 m from what is recorded"]


def near(drone: str, worst: float) -> Claim:
    claim = replace(SPEED, constraint="ground clearance", unit="m", upper=False, limit=2.0)
    return replace(claim, subject=drone, worst=worst, time=16.5)


def test_what_is_come_nearest_to_names_the_drone_where_several_fly() -> None:
    plan = orbit_plan()
    alone = VerifiedIR(plan.trajectory, (SPEED, near("cam1", 2.38)))
    both = VerifiedIR(plan.trajectory, (SPEED, near("cam1", 2.4), near("cam2", 2.38)))
    assert facts(alone, "closest") == ["2.38 m, 2.00 m needed: ground clearance at 0:16.5"]
    assert facts(both, "closest") == [
        "2.38 m, 2.00 m needed: ground clearance of cam2 at 0:16.5",
        "2.40 m, 2.00 m needed: ground clearance of cam1 at 0:16.5",
    ]


def test_of_the_stretches_bent_by_one_cause_the_worst_is_told() -> None:
    plan = orbit_plan()
    bent = tuple(
        PathDeviation("half", distance, 30.0, cause)
        for distance, cause in ((0.59, "zone tree"), (0.2, "drone cam2"), (0.64, "zone tree"))
    )
    changed = VerifiedIR(replace(plan.trajectory, deviations=bent), plan.certificate)
    assert facts(changed, "ideal") == [
        "shot half leaves its ideal by up to 0.64 m: zone tree",
        "shot half leaves its ideal by up to 0.20 m: drone cam2",
    ]


def test_shots_that_their_composition_leaves_in_the_centre_are_told_with_what_moves_them() -> None:
    plan = orbit_plan()
    keyframes = plan.trajectory.keyframes
    (placed,) = keyframes.shots
    for name, told in (("thirds", True), ("center", False)):
        kind = COMPOSITIONS[name]
        shot = replace(
            placed.shot, keyframes=tuple(replace(k, composition=kind) for k in placed.shot.keyframes)
        )
        centre = tuple(replace(k, reference=(0.0, 0.0)) for k in placed.keyframes)
        lines = centred(replace(keyframes, shots=(replace(placed, shot=shot, keyframes=centre),)))
        assert bool(lines) is told
        assert all(f"shot `{shot.id}`" in line and "thirds-first" in line for line in lines)
        third = (replace(centre[0], reference=(1 / 3, 1 / 3)), *centre[1:])
        assert centred(replace(keyframes, shots=(replace(placed, shot=shot, keyframes=third),))) == []


def test_a_mission_without_a_place_on_earth_says_that_no_autopilot_gets_files() -> None:
    plan = orbit_plan(origin=False)
    (note,) = facts(plan, "note")
    assert "no `world.origin`" in note
    assert facts(orbit_plan(), "note") == []
    keyframes = plan.trajectory.keyframes
    listed = replace(keyframes.mission.origins, values={("output", "emit"): WHOLE_FILE})
    mission = replace(keyframes.mission, origins=listed)
    asked = replace(plan, trajectory=replace(plan.trajectory, keyframes=replace(keyframes, mission=mission)))
    assert facts(asked, "note") == [], "the emitters that it lists say by E101 what they cannot write"
