"""The choice of drones for `drone: auto`: exact on small cases, told where there is none."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.api import PlanOptions, compile_source
from shotc.checking import check_source
from shotc.diag.model import Diagnostic
from shotc.kinds.models import mesh_file
from shotc.passes.assign_drones.choice import WORK_PER_METRE_S, choose
from shotc.passes.assign_drones.tasks import CameraEnds, ShotTask
from tests.support.front_passes import clean
from tests.support.meshes import box_mesh, ply
from tests.unit.planning.clock.test_several_drones import HEAD, PASS, SIDE, TAIL

DRONES = {d.name: d for d in clean(HEAD + SIDE + PASS + TAIL).mission.drones}


def task(
    number: int, start: float | None, lasts: float, x: float, y: float, by: str | None = None
) -> ShotTask:
    ends = dict.fromkeys(DRONES, CameraEnds((x, y, 10.0), (x, y, 10.0)))
    return ShotTask(number, f"s{number}", start, lasts, ends, by, DRONES, {})


def cost(tasks: list[ShotTask], names: tuple[str, ...]) -> float | None:
    """Return what one choice costs, None where it cannot be flown; written anew from the rules."""
    for i, a in enumerate(tasks):
        if a.flown_by not in {None, names[i]}:
            return None
        if a.flown_by is None and a.start is not None and a.travel_time(names[i]) > a.start + 1e-6:
            return None
        for j, b in enumerate(tasks):
            if i < j and names[i] == names[j] and a.start is not None and b.start is not None:
                one, two = (a, b) if a.start <= b.start else (b, a)
                if one.start + one.duration + one.to(two, names[i]) > two.start + 1e-6:
                    return None
    work = dict.fromkeys(DRONES, 0.0)
    for t, name in zip(tasks, names, strict=True):
        work[name] += t.duration + 0.5 * (t.travel_time(name) + t.back(name))
    return max(work.values()) + WORK_PER_METRE_S * sum(t.length(n) for t, n in zip(tasks, names, strict=True))


PLACE = st.floats(-80.0, 80.0)
START = st.one_of(st.none(), st.floats(0.0, 120.0))


@pytest.mark.long
@settings(deadline=None, max_examples=60)
@given(st.lists(st.tuples(START, st.floats(1.0, 40.0), PLACE, PLACE), min_size=1, max_size=4))
def test_the_choice_is_the_best_of_all(drawn: list[tuple[float | None, float, float, float]]) -> None:
    tasks = [task(i, *values) for i, values in enumerate(drawn)]
    every = [cost(tasks, names) for names in product(DRONES, repeat=len(tasks))]
    possible = [c for c in every if c is not None]
    found = choose(tasks, tuple(DRONES))
    if not possible:
        assert found is None
        return
    assert found is not None
    taken = cost(tasks, tuple(found[i] for i in range(len(tasks))))
    assert taken is not None
    assert taken <= min(possible) + 1e-3


@pytest.mark.long
def test_the_nearest_drone_films_and_one_drone_is_never_in_two_places() -> None:
    auto = (SIDE + PASS + TAIL).replace("cam1", "auto").replace("cam2", "auto").replace("cam3", "auto")
    done = compile_source((HEAD + auto).encode(), "m.yaml", None, PlanOptions(refiner="none"))
    assert done.plan is not None, done.diagnostics
    shots = {s.id: s.drone for s in done.plan.trajectory.keyframes.mission.shots}
    assert sorted(shots.values()) == ["cam1", "cam2", "cam3"]


@pytest.mark.slow
def test_a_framing_of_free_bearing_is_filmed_from_where_each_drone_comes() -> None:
    """Where it is for the first drone, west of the tower, it is nearer to that one than the crane is."""
    text = """\
shotc: 1
mission: sides
targets: {tower: {at: [0, 0, 12], radius: 4, height: 24}}
drones: {west: {model: x500, home: [-200, 5, 0]}, east: {model: x500, home: [210, -5, 0]}}
shots:
  - {id: crane, kind: crane, drone: auto, target: tower, azimuth: 260 deg, distance: 30, altitude: [10, 12],
     timing: {start: 40, duration: 8}}
  - {id: framing, kind: framing, drone: auto, subjects: [{target: tower}], timing: {start: 40, duration: 8}}
"""
    done = compile_source(text.encode(), "m.yaml", None, PlanOptions(refiner="none", stop_after="resolve"))
    (mission,) = (report.output for report in done.reports if report.name == "resolve")
    assert [(s.id, s.drone) for s in mission.shots] == [("crane", "west"), ("framing", "east")]


def test_scenes_are_not_read_for_every_shot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "house.ply").write_bytes(ply(box_mesh((300.0, 300.0, 3.0), (10.0, 8.0, 6.0))))
    read: list[str] = []
    one = mesh_file.read_ply
    monkeypatch.setattr(mesh_file, "read_ply", lambda data: read.append("house") or one(data))
    text = HEAD + (SIDE + PASS + TAIL).replace("cam1", "auto")
    text = text.replace("targets:", "world: {scene: {file: house.ply, units: m}}\ntargets:", 1)
    done = compile_source(
        text.encode(), "m.yaml", tmp_path, PlanOptions(refiner="none", stop_after="resolve")
    )
    assert "N009" not in {d.code for d in done.diagnostics}
    assert read == ["house"]


def test_a_mission_without_drones_is_told_by_check_and_by_plan_alike() -> None:
    head, _, rest = HEAD.partition("drones:")
    text = head + "shots:\n" + rest.partition("shots:\n")[2] + SIDE.replace("cam1", "auto")
    (told,) = check_source(text.encode(), "m.yaml", None).diagnostics
    assert (told.code, told.message) == ("K014", "there is no drone to choose from")
    done = compile_source(text.encode(), "m.yaml", None, PlanOptions(refiner="none"))
    assert done.diagnostics == (told,)


def test_more_shots_at_a_time_than_drones_are_told_with_the_time() -> None:
    text = (
        HEAD.split("  cam2:")[0] + "shots:\n" + (SIDE + PASS).replace("cam1", "auto").replace("cam2", "auto")
    )
    assert check_source(text.encode(), "m.yaml", None).diagnostics == ()
    done = compile_source(text.encode(), "m.yaml", None, PlanOptions(refiner="none"))
    assert [d.code for d in done.diagnostics] == ["K014"]
    assert done.diagnostics[0].message == "2 shots are filmed at t = 15.0 s, and there is 1 drone"


@pytest.mark.parametrize("wrong", ["altitude: 1", "target: nobody"])
def test_what_is_wrong_by_itself_is_told_as_ever(wrong: str) -> None:
    right = "altitude: 4" if "altitude" in wrong else "target: runner"
    text = HEAD + SIDE.replace("cam1", "auto").replace(right, wrong)
    done = compile_source(text.encode(), "m.yaml", None, PlanOptions(refiner="none"))
    assert [d.code for d in done.diagnostics] == ["M006" if "altitude" in wrong else "N001"]


LENSES = """\
shotc: 1
mission: lenses
targets: {tower: {at: [0, 0, 12], radius: 4, height: 24}}
drones:
  near: {model: x500, home: [0, -50, 0], camera: {hfov: 20 deg}}
  far: {model: x500, home: [0, -150, 0]}
shots:
  - {id: rise, kind: elevator, drone: auto, target: tower, azimuth: 180 deg, distance: 50, altitude: [8, 14]}
"""


def chosen(text: str) -> tuple[dict[str, str], list[str]]:
    """Return the drone of every shot, and the codes, of a mission whose keyframes are placed."""
    done = compile_source(text.encode(), "m.yaml", None, PlanOptions(stop_after="place-keyframes"))
    (spec,) = (report.output.spec for report in done.reports if report.name == "assign-drones")
    return {s.id: s.drone for s in spec.shots}, [d.code for d in done.diagnostics]


@pytest.mark.slow
def test_a_drone_whose_lens_shows_the_whole_target_is_preferred() -> None:
    assert chosen(LENSES) == ({"rise": "far"}, ["K023"])
    assert chosen(LENSES.replace("drone: auto", "drone: far")) == ({"rise": "far"}, [])


@pytest.mark.slow
def test_where_no_drone_can_film_a_shot_the_nearest_is_told_the_fault() -> None:
    both = LENSES.replace("-150, 0]}", "-150, 0], camera: {hfov: 20 deg}}")
    assert chosen(both) == ({"rise": "near"}, ["G010"])


@pytest.mark.slow
def test_a_shot_that_the_first_drone_alone_cannot_film_is_not_given_to_it() -> None:
    """The first drone is too slow for the target, so the shot does not even resolve with it."""
    car = "car: {track: {start: [0, 0, 0.8], velocity: [5, 0, 0]}, radius: 1, height: 1.6}"
    text = LENSES.replace("camera: {hfov: 20 deg}", "limits: {speed: 2 m/s}")
    text = text.replace("targets: {", f"targets: {{{car}, ")
    text += (
        "  - {id: car, kind: chase, drone: auto, target: car, distance: 15, altitude: 5,\n"
        "     timing: {start: 30, duration: 8}}\n"
    )
    drones, codes = chosen(text)
    assert drones["car"] == "far"
    assert codes == []


def test_as_few_shots_as_possible_go_to_drones_that_cannot_film_them() -> None:
    """Two shots at a time, one drone that can film both: the other one gets the shorter way."""
    refused = {"cam2": Diagnostic("G010", "does not fit"), "cam3": Diagnostic("G010", "does not fit")}
    tasks = [task(i, 60.0, 10.0, 20.0 * i, 0.0)._replace(refused=refused) for i in range(2)]
    found = choose(tasks, tuple(DRONES))
    assert found is not None
    assert sorted(found.values())[0] == "cam1"
    assert len(set(found.values())) == 2
