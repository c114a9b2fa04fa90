"""verify --abort-every: what is printed, the exit status, and what it is not for."""

import json
from pathlib import Path

import pytest

from shotc.emit.plan_json import EMITTER
from tests.cli.conftest import Run
from tests.support.compiled import compiled_text

pytestmark = pytest.mark.slow

SHOW = """\
shotc: 1
mission: show
fleets:
  swarm: {count: 8, layout: {grid: {spacing: 4}}, separation: 2 m}
shots:
  - {id: cube, kind: display, fleet: swarm, frames: [{cube: {center: [6, 6, 26], size: 9}, hold: 4}]}
"""


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    done = compiled_text(SHOW)
    assert done.plan is not None
    path = tmp_path / "plan.json"
    path.write_bytes(EMITTER.emit(done.plan).artifacts[0].data)
    return path


def test_the_table_tells_the_longest_and_the_nearest(run: Run, plan: Path) -> None:
    done = run("verify", str(plan), "--abort-every", "2s")
    assert done.code == 0
    assert "returns hold, one every 2 s from lift-off to landing" in done.out
    assert "longest" in done.out
    assert "nearest drones" in done.out


def test_json_has_every_return(run: Run, plan: Path) -> None:
    done = run("verify", str(plan), "--abort-every", "2", "--format", "json")
    found = json.loads(done.out)["returns"]
    assert [r["time"] for r in found] == [2.0 * (k + 1) for k in range(len(found))]
    assert all(r["holds"] and r["landed"] >= r["time"] for r in found)


@pytest.mark.parametrize("text", ["0 s", "2 m", "often", "²"])
def test_what_is_no_time_is_a_usage_error(run: Run, plan: Path, text: str) -> None:
    done = run("verify", str(plan), "--abort-every", text)
    assert (done.code, "--abort-every" in done.err) == (2, True)
