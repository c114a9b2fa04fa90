"""What `shotc fly` prints of a show's plan, and how it ends."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from shotc.emit.plan_json import EMITTER
from shotc.ir.show import Apart
from tests.cli.conftest import Run
from tests.support.film_plans import orbit_plan
from tests.support.show_plans import PADS, fleet, mission, plan

pytestmark = pytest.mark.slow


@pytest.fixture
def written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Give the command a plan made by hand, which has no mission in a file that it could be held to."""

    def made(flown) -> str:
        path = tmp_path / "plan.json"
        path.write_bytes(EMITTER.emit(flown).artifacts[0].data)
        monkeypatch.setattr("shotc.cli.fly.proved", lambda _path: flown)
        return str(path)

    return made


@pytest.fixture
def show(written) -> str:
    return written(plan())


def test_it_says_how_far_drones_stray_and_how_near_they_come(run: Run, show: str) -> None:
    done = run("fly", show)
    assert done.code == 0
    heading, row, *remarks = done.out.splitlines()
    assert heading.split()[:4] == ["fleet", "drones", "strays,", "RMS"]
    assert row.split()[:2] == ["swarm", "4"]
    # All four do the same in still air: they stay as far apart as their pads.
    assert "4.00 m" in row
    assert row.endswith("1 m    0.15 m")
    assert remarks[1].startswith("swarm: swarm-1 strays farthest, at 0:")
    assert run("fly", show).out == done.out


def test_gusts_depend_on_their_seed_and_take_from_the_separation(run: Run, show: str) -> None:
    (still,), (one,), (same,), (other,) = (
        json.loads(run("fly", show, "--format", "json", *more).out)["fleets"]
        for more in (
            (),
            ("--gusts", "0.5"),
            ("--gusts", "0.5", "--seed", "1"),
            ("--gusts", "0.5", "--seed", "2"),
        )
    )
    assert one == same
    assert one != other
    assert still["rmse"] < one["rmse"] < one["farthest"]
    assert one["near"]["distance"] < still["near"]["distance"] == pytest.approx(4.0, abs=1e-6)
    assert one["near"]["distance"] > 4.0 - 2 * one["farthest"]


def test_it_tells_where_drones_come_nearer_than_asked(run: Run, written) -> None:
    tight = fleet(PADS)._replace(apart=Apart("ellipsoid", 3.9, 3.9, 0.0))
    done = run("fly", written(plan(mission(fleets=(tight,)))), "--gusts", "0.5")
    assert done.code == 0
    assert "nearer than the separation" in done.out
    assert "margin" in done.out.splitlines()[-1]


@pytest.mark.parametrize(
    ("margin", "verdict"),
    [(0.8, "no two drones can come too near in this wind"), (0.0, "the margin was enough in this run")],
)
def test_it_judges_the_margin(run: Run, written, margin: float, verdict: str) -> None:
    roomy = fleet(PADS)._replace(apart=Apart("ellipsoid", 1.0, 1.0, margin))
    show = written(plan(mission(fleets=(roomy,))))
    said = run("fly", show).out.splitlines()[-1]
    assert verdict in said
    (row,) = json.loads(run("fly", show, "--format", "json").out)["fleets"]
    assert (margin >= 2 * row["farthest"]) == (margin > 0)
    if not margin:
        proposed = float(re.search(r"\{margin: ([\d.]+)\}", said)[1])
        assert 2 * row["farthest"] <= proposed <= 2 * row["farthest"] + 0.1


def test_a_plan_without_fleets_is_a_mistake_of_usage(run: Run, written) -> None:
    from shotc.ir.passes import PassContext
    from shotc.passes.verify import Verify

    made = Verify().run(orbit_plan().trajectory, PassContext()).value
    done = run("fly", written(made))
    assert done.code == 2
    assert "no fleet" in done.err


def test_wind_that_no_margin_makes_up_for_is_told_as_that(run: Run, written) -> None:
    tight = fleet(PADS)._replace(apart=Apart("ellipsoid", 0.5, 0.5, 0.0))
    last = run("fly", written(plan(mission(fleets=(tight,)))), "--gusts", "3").out.splitlines()[-1]
    assert "do not fly this show in such wind" in last
    assert "{margin:" not in last
