"""Many runs: who flies them does not matter, and what is done need not be done again."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from shotc.simulation import runs
from shotc.simulation.conditions import Conditions
from shotc.simulation.runs import RunBlock, simulated
from shotc.simulation.unfinished import NAME, Unfinished
from shotc.simulation.wind import WindField
from tests.support.film_plans import orbit_plan
from tests.support.show_plans import plan as show_plan

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[3]
WINDY = Conditions(wind=WindField(2.0, None, 0.5))


@pytest.fixture(autouse=True)
def _small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runs, "BLOCK_RUNS", 2)


@pytest.fixture(scope="module")
def ir():
    return orbit_plan().trajectory


@pytest.fixture(scope="module")
def first(ir) -> RunBlock:
    return runs.fly_block(ir, WINDY, range(2))


def test_what_was_kept_comes_back_as_it_was(tmp_path, ir, first) -> None:
    kept = Unfinished.of(tmp_path / "new", ir, WINDY)
    kept.add(first)
    (again,) = kept.done()
    assert again.runs == first.runs
    assert again.strays is not None
    assert first.strays is not None
    assert (again.strays.metres == first.strays.metres).all()
    kept.file.forget()
    assert not kept.done()
    assert not (tmp_path / "new" / NAME).exists()


def test_shows_come_back_too(tmp_path) -> None:
    trajectory = show_plan().trajectory
    block = runs.fly_block(trajectory, WINDY, range(1))
    kept = Unfinished.of(tmp_path, trajectory, WINDY)
    kept.add(block)
    assert [each.runs for each in kept.done()] == [block.runs]


def test_blocks_that_were_done_are_not_flown_again(monkeypatch, ir, first) -> None:
    flown = []

    def fly_block(_ir, _conditions, block):
        flown.append(list(block))
        return RunBlock(tuple(replace(first.runs[0], number=n) for n in block), first.strays)

    monkeypatch.setattr(runs, "fly_block", fly_block)
    blocks = list(simulated(ir, WINDY, 5, 1, [first]))
    assert flown == [[2, 3], [4]]
    assert [run.number for block in blocks for run in block.runs] == [0, 1, 2, 3, 4]
    flown.clear()
    # A last block that was shorter than it is now is no use.
    list(simulated(ir, WINDY, 2, 1, [replace(first, runs=first.runs[:1])]))
    assert flown == [[0, 1]]


@pytest.mark.parametrize(
    "line",
    ["", "{", '{"key": "KEY"}', '{"key": "KEY", "runs": [{"number": "x"}]}', '["KEY"]', "\x00", "null"],
)
def test_lines_that_are_not_whole_are_passed_over(tmp_path, ir, first, line) -> None:
    kept = Unfinished.of(tmp_path, ir, WINDY)
    kept.file.path.write_text(line.replace("KEY", kept.key) + "\n")
    kept.add(first)
    assert [block.runs for block in kept.done()] == [first.runs]


def test_what_belongs_to_other_conditions_is_passed_over(tmp_path, ir, first) -> None:
    Unfinished.of(tmp_path, ir, WINDY).add(first)
    assert not Unfinished.of(tmp_path, ir, replace(WINDY, seed=2)).done()
    document = json.loads((tmp_path / NAME).read_text())
    assert document["key"] != Unfinished.of(tmp_path, ir, replace(WINDY, loop="track")).key


CLUSTER = """
import sys
from distributed import LocalCluster
from shotc import cluster
from shotc.simulation import runs
from shotc.parallel import NoCluster
from tests.support.film_plans import orbit_plan
from tests.unit.simulation.test_runs import WINDY

cluster.ANSWERS_S = 1
ir = orbit_plan().trajectory
try:
    list(runs.simulated(ir, WINDY, 2, "tcp://127.0.0.1:9"))
except NoCluster:
    print("nobody answers")
with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None) as here:
    (block,) = runs.simulated(ir, WINDY, 2, here.scheduler_address)
print(repr(block.runs))
"""


@pytest.mark.long
def test_a_cluster_flies_the_same_runs_and_where_none_answers_it_is_told(first) -> None:
    """In a process of its own: a cluster leaves threads, and where there are threads nothing may fork."""
    pytest.importorskip("distributed")
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", CLUSTER], capture_output=True, text=True, check=False, cwd=ROOT
    )
    assert done.stdout.splitlines() == ["nobody answers", repr(first.runs)], done.stderr
