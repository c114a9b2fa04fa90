"""What `shotc simulate` prints and writes of plans and missions, and how it ends."""

from __future__ import annotations

import csv
import json
import re
import sys
from io import StringIO
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from shotc.api import PlanReport
from shotc.ir.rehearsal import Rehearsal, RehearsalPromise
from shotc.ir.show import Apart
from shotc.parallel import NoCluster
from tests.cli.conftest import Run
from tests.support.compiled import compiled_text
from tests.support.records import replace
from tests.support.show_plans import PADS, fleet, mission, plan

pytestmark = pytest.mark.slow

WALKER = """\
shotc: 1
mission: walker
world: {wind: {speed: 2 m/s, from: 270 deg}}
targets:
  walker: {track: {start: [0, 0, 0.9], velocity: [1.2, 0, 0]}, radius: 0.4, height: 1.8}
drones: {cam: {model: x500, home: [-4, 0, 0]}}
shots:
  - {id: follow, kind: chase, drone: cam, target: walker, distance: 8, altitude: 3,
     timing: {start: 7.5, duration: 5}}
rehearse:
  gusts: 1 m/s
  runs: 4
  require: {in_frame: 95 %, mean_error: 0.005, of: 75 %}
"""


def walk():
    """The plan of ``WALKER``, a flight of 22 s."""
    done = compiled_text(WALKER, "none")
    assert done.plan is not None, done.diagnostics
    return done.plan


def asking(promise: RehearsalPromise | None = None):
    """Return the same flight in a mission without wind, which asks something of rehearsals or nothing."""
    asked = promise and Rehearsal(promise, ("rehearse",), 3, "replay", None, 0.5, "rtk", 0.0)
    return with_mission(walk(), rehearsal=asked, wind=0.0, wind_toward=None)


def with_mission(made, **changes):
    """Return a plan whose mission is another one."""
    keyframes = made.trajectory.keyframes
    keyframes = keyframes._replace(mission=keyframes.mission._replace(**changes))
    return replace(made, trajectory=replace(made.trajectory, keyframes=keyframes))


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave pictures and recordings empty, for tests that do not look at them."""
    monkeypatch.setattr("shotc.simulation.outputs.draw", lambda _done: b"")
    monkeypatch.setattr("shotc.simulation.recording.recording", lambda *_: b"")


@pytest.fixture
def given(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    """Give the command a plan that has no mission in a file that it could be held to."""

    def made(flown) -> str:
        report = PlanReport(flown, (), (), {})
        monkeypatch.setattr("shotc.cli.simulate.prove", lambda _path: report)
        (tmp_path / "out").mkdir(exist_ok=True)
        return "out"

    return made


def document(folder: str = "out"):
    return json.loads((Path(folder) / "simulate.json").read_text())


@pytest.mark.long
def test_a_film_is_flown_and_written(run: Run, given) -> None:
    done = run("simulate", given(asking()), "--runs", "3", "--gusts", "0.5", "--wind", "2")
    assert done.code == 0
    assert "3 runs, wind 2 m/s from any side, gusts 0.5 m/s" in done.out
    assert {path.name for path in Path("out").iterdir()} == {
        "walker-report.html",
        "simulate.json",
        "flight.csv",
        "simulate.png",
        "simulate.rrd",
    }
    assert Path("out/simulate.png").read_bytes()[:4] == b"\x89PNG"
    assert Path("out/simulate.rrd").read_bytes()[:4] == b"RRF2"
    made = document()
    assert [each["number"] for each in made["runs"]] == [0, 1, 2]
    assert made["kept"]
    rows = list(csv.DictReader(StringIO(Path("out/flight.csv").read_text())))
    assert {row["run"] for row in rows} == {str(made["worst_run"])}
    off = [[float(r[f"{a}_m"]) - float(r[f"plan_{a}_m"]) for a in "xyz"] for r in rows]
    course = made["runs"][made["worst_run"]]["courses"][0]
    assert np.linalg.norm(off, axis=1).max() == pytest.approx(course["farthest"], abs=0.01)
    assert np.linalg.norm(off[-1][:2]) == pytest.approx(course["landed"], abs=0.02)


@pytest.mark.long
@pytest.mark.usefixtures("undrawn")
def test_the_same_seed_gives_the_same_bytes_however_many_processes_fly(run: Run, given, monkeypatch) -> None:
    monkeypatch.setattr("shotc.simulation.runs.BLOCK_RUNS", 2)
    documents = []
    for more in (("--jobs", "1"), ("--jobs", "2"), ("--seed", "2")):
        run("simulate", given(asking()), "--seeds", "3", "--gusts", "0.5", "--gps", "plain", *more)
        documents.append(Path("out/simulate.json").read_text())
    assert documents[0] == documents[1]
    assert documents[0] != documents[2]


@pytest.mark.usefixtures("undrawn")
def test_what_too_few_runs_keep_is_an_error_at_its_line(run: Run, given) -> None:
    done = run("simulate", given(asking(RehearsalPromise(stray=0.01, of=0.6))))
    assert done.code == 1
    assert "W001" in done.err
    assert re.search(
        r"a drone strays [\d.]+ m from its plan in run \d; 0.01 m is required in 2 of 3 runs", done.err
    )
    kept = float(re.search(r"2 of 3 runs keep: `stray: ([\d.]+)`", done.err)[1])
    strays = sorted(max(c["farthest"] for c in each["courses"]) for each in document()["runs"])
    assert strays[1] <= kept <= strays[1] + 0.001
    assert not document()["kept"]


@pytest.mark.long
@pytest.mark.usefixtures("undrawn")
def test_what_the_help_proposes_is_kept(run: Run, given) -> None:
    first = run("simulate", given(asking(RehearsalPromise(mean_error=0.0, clearance=1000.0))))
    error = float(re.search(r"`mean_error: ([\d.]+)`", first.err)[1])
    clearance = float(re.search(r"`clearance: ([\d.]+)`", first.err)[1])
    again = run("simulate", given(asking(RehearsalPromise(mean_error=error, clearance=clearance))))
    assert (first.code, again.code) == (1, 0)


def test_wind_as_fast_as_the_drone_is_refused_before_anything_flies(run: Run, given) -> None:
    done = run("simulate", given(asking()), "--wind", "30")
    assert done.code == 1
    assert "W003" in done.err
    assert not list(Path("out").iterdir())


@pytest.mark.usefixtures("undrawn")
@pytest.mark.filterwarnings("error")
def test_gusts_that_nobody_flies_in_leave_numbers_finite(run: Run, given) -> None:
    done = run("simulate", given(walk()), "--gusts", "30", "--seeds", "3", "--bias", "2.5")
    assert done.code == 1
    assert "positions within 0.02 m of 2.5 m too far east" in done.out
    made = document()
    depth = [min(n["distance"] for c in each["courses"] for n in c["near"]) for each in made["runs"]]
    assert made["worst_run"] == int(np.argmin(depth))
    assert re.search(rf"a drone's body is [\d.]+ m into something in run {made['worst_run']}", done.err)
    assert "NaN" not in Path("out/simulate.json").read_text()


@pytest.mark.long
@pytest.mark.usefixtures("undrawn")
def test_a_mission_is_planned_and_flown_in_its_own_wind(run: Run) -> None:
    Path("walker.yaml").write_text(WALKER)
    done = run("simulate", "walker.yaml")
    assert done.code == 1
    assert "walker: 4 runs, wind 2 m/s from 270 deg, gusts 1 m/s" in done.out
    assert "loop: track" in done.err
    assert re.search(r"walker.yaml:13:\d+\n", done.err)
    replayed = [each["pictures"][0]["error"] for each in document("out/walker")["runs"]]
    assert run("plan", "walker.yaml", "--refiner", "none", "--emit", "csv").code == 0
    run("simulate", "out/walker", "--loop", "track")
    tracked = [each["pictures"][0]["error"] for each in document("out/walker")["runs"]]
    assert np.mean(tracked) < 0.5 * np.mean(replayed)
    assert document("out/walker")["conditions"]["loop"] == "track"


@pytest.mark.long
@pytest.mark.usefixtures("undrawn")
def test_a_target_may_really_go_elsewhere(run: Run, given) -> None:
    Path("late.csv").write_text("t,x,y,z\n0,0,0,0.9\n60,66,6,0.9\n")
    run("simulate", given(walk()), "--truth", "walker=late.csv", "--seeds", "1")
    replayed = document()["runs"][0]["pictures"][0]["error"]
    run("simulate", given(walk()), "--truth", "walker=late.csv", "--seeds", "1", "--loop", "track")
    tracked = document()["runs"][0]["pictures"][0]["error"]
    assert tracked < 0.05
    assert replayed > 0.15


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("t,x,y,z\n0,0,0,0.9\n9,9,0,0.9\n", "ends at 9 s"),
        ("t,x,y,z\n0,0,0,0.9\n9,9,0,0.9\n10,900,0,0.9\n99,950,0,0.9\n", "jumps 891.0 m in 1 s at 9 s"),
        ("t,x,y,z\n0,0,0,0.9\n", "the file has one row"),
    ],
)
def test_a_truth_that_cannot_be_is_refused(run: Run, given, rows: str, words: str) -> None:
    Path("true.csv").write_text(rows)
    done = run("simulate", given(walk()), "--truth", "walker=true.csv")
    assert done.code == 1
    assert words in done.err
    assert "Traceback" not in done.err
    assert not list(Path("out").iterdir())


@pytest.mark.parametrize(
    "options",
    [
        ("--lost", "5"),
        ("--lost", "9:5"),
        ("--lost", "nobody=5:9"),
        ("--lost", "walker="),
        ("--truth", "nobody=x.csv"),
        ("--truth", "walker"),
        ("--loop", "no"),
        ("--bias", "nan"),
        ("--gusts", "inf"),
        ("--wander", "inf"),
    ],
)
def test_options_that_mean_nothing_are_mistakes_of_usage(run: Run, given, options: tuple[str, ...]) -> None:
    assert run("simulate", given(walk()), *options).code == 2


@pytest.mark.long
@pytest.mark.usefixtures("undrawn")
def test_a_drone_that_plans_anew_is_told_of_and_one_that_cannot_is_refused(run: Run, given) -> None:
    done = run("simulate", given(walk()), "--loop", "replan", "--seeds", "2")
    assert re.search(r"cam: planned anew 2\d times, 0 in vain", done.out)
    assert run("simulate", "out", "--loop", "replan", "--replanner", "nobody").code == 2


def test_a_mission_without_a_plan_is_told_as_plan_tells_it(run: Run) -> None:
    Path("walker.yaml").write_text(WALKER.replace("target: walker", "target: nobody"))
    done = run("simulate", "walker.yaml")
    assert done.code == 1
    assert "nobody" in done.err


@pytest.fixture
def show(given) -> str:
    return given(plan())


@pytest.mark.long
def test_fleets_are_flown_and_their_strays_told(run: Run, show: str) -> None:
    done = run("simulate", show, "--seeds", "2")
    assert done.code == 0
    assert re.search(r"swarm +4 ", done.out)
    # All four do the same in still air: they stay as far apart as their pads.
    assert "4.00 m" in done.out
    assert "swarm-1 strays farthest, at 0:" in done.out
    assert "without gusts all runs are the same, so one is flown" in done.out
    assert len(document()["runs"]) == 1
    assert {path.name for path in Path("out").iterdir()} == {
        "simulate.json",
        "simulate.png",
        "show-report.html",
    }
    told = Path("out/show-report.html").read_text()
    assert "Flown in simulation: 1 run, no gusts." in told
    assert "Run shotc simulate for that" not in told


@pytest.mark.long
@pytest.mark.usefixtures("undrawn")
def test_gusts_take_from_the_separation(run: Run, show: str) -> None:
    def near(*more: str) -> list[float]:
        run("simulate", show, *more)
        return [each["fleets"][0]["flown"]["near"]["distance"] for each in document()["runs"]]

    assert near("--seeds", "1") == pytest.approx([4.0], abs=1e-6)
    one, other = near("--seeds", "2", "--gusts", "0.5")
    assert one != other
    assert max(one, other) < 4.0


@pytest.mark.long
@pytest.mark.usefixtures("undrawn")
def test_a_show_says_that_it_feels_no_steady_wind_and_refuses_one_above_its_speed(run: Run, show) -> None:
    done = run("simulate", show, "--seeds", "1", "--wind", "1")
    assert ": 1 run, no gusts\n" in done.out
    assert "fleets fly in gusts alone" in done.out
    done = run("simulate", show, "--seeds", "1", "--wind", "90")
    assert done.code == 1
    assert "carries fleet `swarm` away" in done.err


@pytest.mark.long
@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize(
    ("margin", "verdict"),
    [(0.8, "no two drones can come too near in this wind"), (0.0, "the margin was enough in these runs")],
)
def test_the_margin_is_judged(run: Run, given, margin: float, verdict: str) -> None:
    roomy = fleet(PADS)._replace(apart=Apart("ellipsoid", 1.0, 1.0, margin))
    done = run("simulate", given(plan(mission(fleets=(roomy,)))), "--seeds", "1")
    assert verdict in done.out
    if not margin:
        farthest = document()["runs"][0]["fleets"][0]["flown"]["farthest"]
        proposed = float(re.search(r"\{margin: ([\d.]+)\}", done.out)[1])
        assert 2 * farthest <= proposed <= 2 * farthest + 0.1


@pytest.mark.long
@pytest.mark.usefixtures("undrawn")
def test_drones_nearer_than_asked_are_told(run: Run, given) -> None:
    tight = fleet(PADS)._replace(apart=Apart("ellipsoid", 3.9, 3.9, 0.0))
    done = run("simulate", given(plan(mission(fleets=(tight,)))), "--seeds", "1", "--gusts", "0.5")
    assert "nearer than the separation" in done.out


@pytest.mark.usefixtures("undrawn")
def test_wind_that_no_margin_makes_up_for_is_told_as_that(run: Run, given) -> None:
    tight = fleet(PADS)._replace(apart=Apart("ellipsoid", 0.5, 0.5, 0.0))
    said = run("simulate", given(plan(mission(fleets=(tight,)))), "--seeds", "1", "--gusts", "3").out
    assert "do not fly this show in such wind" in said
    assert "{margin:" not in said


def test_where_no_cluster_answers_it_is_told(run: Run, given, monkeypatch) -> None:
    def nobody(*_: object) -> object:
        raise NoCluster("timed out")

    # Whoever loads the library itself has threads from then on.
    monkeypatch.setitem(sys.modules, "shotc.cluster", SimpleNamespace(on_cluster=nobody))
    done = run("simulate", given(walk()), "--seeds", "2", "--workers", "tcp://127.0.0.1:9")
    assert done.code == 1
    assert "W006" in done.err
