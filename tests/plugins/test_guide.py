"""The guide for authors of plugins: it explains every public name and no other, and its examples run."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from shotc import plugin_api, plugins
from shotc.api import PlanOptions, compile_source, emit_plan
from shotc.checking import check_source
from shotc.plugin_api import refiner, replanner
from tests.support.replans import problem, situation

GUIDE = (Path(__file__).parents[2] / "shotc" / "docs" / "plugins.md").read_text(encoding="utf-8")
_, _, AFTER = GUIDE.partition("## Names of `shotc.plugin_api`\n")
NAMES, _, REST = AFTER.partition("## Names of `shotc.plugin_api.refiner`\n")
REFINER_NAMES, _, REPLANNER_NAMES = REST.partition("## Names of `shotc.plugin_api.replanner`\n")
EXAMPLES = {
    name: body for body, name in re.findall(r'```python\n("""shotc_(\w+)\.py: .*?)```', GUIDE, re.DOTALL)
}
(SWING,) = re.findall(r"```yaml\n(.*?)```", GUIDE, re.DOTALL)
RUN = """\
shotc: 1
mission: run
targets: {runner: {track: {start: [0, 0, 0.9], velocity: [1.5, 0, 0]}, radius: 0.4, height: 1.8}}
drones: {cam: {model: x500, home: [0, -30, 0]}}
shots:
  - {id: behind, kind: shoulder, drone: cam, target: runner, timing: {duration: 6},
     behind: 8, left: 3, altitude: 3}
"""
PASS = """\
shotc: 1
mission: pass
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones: {cam: {model: x500, home: [0, -50, 0]}}
shots:
  - {id: by, kind: keyframes, drone: cam, target: mast, composition: center, require: {screen_error: 0.5},
     keyframes: [{at: [-25, -30, 8], look_at: mast}, {at: [25, -25, 12], look_at: mast}]}
"""


def named(text: str) -> list[str]:
    return re.findall(r"^\| `(\w+)(?:\(.*?\))?` \| \S", text, re.MULTILINE)


@pytest.mark.parametrize(
    ("text", "module"), [(NAMES, plugin_api), (REFINER_NAMES, refiner), (REPLANNER_NAMES, replanner)]
)
def test_every_public_name_is_explained_once_and_no_other(text, module):
    assert sorted(named(text)) == sorted(module.__all__)
    assert f"from {module.__name__} import NAME" in text


def test_every_public_name_can_be_imported():
    assert sorted(plugin_api._HOMES) == sorted(plugin_api.__all__)
    assert all(getattr(plugin_api, name) is not None for name in plugin_api.__all__)


@pytest.fixture
def examples(install):
    """All examples of the guide, as packages of their own."""
    group = {
        "pendulum": "kinds",
        "shoulder": "kinds",
        "shotlist": "emitters",
        "on_mark": "refiners",
        "brake": "replanners",
    }
    assert set(group) == set(EXAMPLES)
    for module, source in EXAMPLES.items():
        install(f"my-{module}".replace("_", "-"), module.replace("_", "-"), source, group[module])


def planned(mission, **options):
    done = compile_source(mission.encode(), "m.yaml", None, PlanOptions(**{"refiner": "none", **options}))
    assert done.plan is not None, done.diagnostics
    return done


@pytest.mark.slow
def test_the_kinds_plan_with_targets_that_stand_and_that_move(examples):
    shot = planned(SWING).plan.trajectory.keyframes.mission.shots[0]
    first, *_, last = (k.at for k in shot.keyframes)
    assert first == pytest.approx(last)
    assert planned(RUN).plan is not None
    moving = SWING.replace("at: [0, 0, 6]", "track: {start: [0, 0, 6], velocity: [0.5, 0, 0]}")
    assert planned(moving.replace("swing: 40 deg", "swing: 40 deg, timing: {duration: 20}")).plan is not None


def test_the_kind_refuses_what_its_parameters_do_not_allow(examples):
    far, still = (SWING.replace("swing: 40 deg", f"swing: {angle}") for angle in ("200 deg", "0 deg"))
    (fault,) = check_source(far.encode(), "m.yaml", None).diagnostics
    assert "above" in fault.message
    (fault,) = check_source(still.encode(), "m.yaml", None).diagnostics
    assert (fault.code, "`swing`" in fault.help) == ("K010", True)


@pytest.mark.slow
def test_the_emitter_lists_the_shots(examples):
    plan = planned(SWING).plan
    (table,) = (a for a in emit_plan(plan, ["shotlist"]).artifacts if a.name == "shots.csv")
    head, row, end = table.data.decode().split("\n")
    assert (head, end) == ("drone,shot,start_s,end_s", "")
    assert row.startswith("cam,to-and-fro,")


@pytest.mark.slow
def test_the_refiner_is_taken_and_keeps_the_target_nearer_to_its_place(examples):
    def worst(plan):
        return max(c.worst for c in plan.certificate if c.constraint == "mast screen error")

    convex, refined = (planned(PASS, refiner=name) for name in ("none", "on-mark"))
    assert refined.diagnostics == ()
    assert worst(refined.plan) < 0.1 * worst(convex.plan)


def test_the_package_of_the_guide_registers_its_kind():
    (text,) = re.findall(r"```toml\n(.*?)```", GUIDE, re.DOTALL)
    project = tomllib.loads(text)["project"]
    (group,) = project["entry-points"]
    assert group in plugins.GROUPS.values()
    assert project["entry-points"][group] == {"pendulum": "shotc_pendulum:PLUGIN"}


def test_the_replanner_comes_to_rest_at_the_limit_of_acceleration(examples):
    source = plugins.one("replanners", "brake")
    assert source.package == "my-brake"
    planner = source.plugin.chase(problem(20))
    plan = planner.replan(situation(20, velocity=np.array([3.0, 4.0, 0.0])), None).plan
    assert plan.velocities[-1] == pytest.approx(np.zeros(3), abs=1e-12)
    assert np.linalg.norm(plan.accelerations[0]) == pytest.approx(5.0)
    assert np.linalg.norm(plan.places[-1] - plan.places[0]) == pytest.approx(2.5)
    assert planner.replan(situation(20, velocity=np.full(3, np.nan)), plan).status == "failed"
