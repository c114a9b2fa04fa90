"""shotc plan of several missions: side by side, each into its folder, and none twice where it is stopped."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from shotc import parallel
from shotc.batch.record import NAME
from tests.cli.conftest import GOOD, Run

ROOT = Path(__file__).parents[2]
FAST = ("--refiner", "none", "--emit", "csv")
BAD = GOOD.replace("look_at: tower", "look_at: towr").replace("mission: look", "mission: bad")


@pytest.fixture
def missions(tmp_path: Path) -> Path:
    """A folder with two missions, one of which is rejected, and a file that is none."""
    folder = tmp_path / "missions"
    (folder / "below").mkdir(parents=True)
    (folder / "a.yaml").write_text(GOOD.replace("mission: look", "mission: first"))
    (folder / "below" / "b.yaml").write_text(BAD)
    (folder / "note.yaml").write_text("a: 1\n")
    return folder


@pytest.mark.slow
def test_missions_of_a_folder_are_planned_each_into_its_own(run: Run, missions: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = run("plan", str(missions), "-o", str(out), "--jobs", "1", *FAST)
    assert done.code == 1
    assert sorted(path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()) == [
        "first/framing.csv",
        "first/plan.json",
        "first/trajectory.csv",
    ]
    rows = [line.split("  ") for line in done.out.splitlines()]
    table = {row[0].rsplit("/", 1)[-1]: [cell.strip() for cell in row[1:] if cell.strip()] for row in rows}
    assert table["a.yaml"][-1] == f"{out}/first/"
    assert table["b.yaml"] == ["-", "-", "-", "none: 1 error"]
    claims = json.loads((out / "first" / "plan.json").read_text())["certificate"]
    assert table["a.yaml"][1] == str(len(claims))
    assert "planned 1 of 2 missions; passed over 1 YAML file" in done.out
    assert "error[N001]" in done.err
    assert "towr" in done.err
    single = tmp_path / "alone"
    assert run("plan", str(missions / "a.yaml"), "-o", str(single), *FAST).code == 0
    assert {p.name: p.read_bytes() for p in single.iterdir()} == {
        p.name: p.read_bytes() for p in (out / "first").iterdir()
    }


@pytest.mark.slow
def test_a_batch_that_was_stopped_goes_on_from_there(run: Run, missions: Path, tmp_path: Path) -> None:
    """What is planned is not planned again, unless a file that was read or written has changed since."""
    out = tmp_path / "out"
    second = missions / "below" / "b.yaml"
    second.write_text(GOOD.replace("mission: look", "mission: second"))
    command = ("plan", str(missions), "-o", str(out), "--jobs", "1", *FAST)
    assert run(*command, "--seed", "7").code == 0
    assert not (out / NAME).exists()

    stopped = _stop_after_the_first(run, command)
    assert "before this run was stopped" not in stopped
    (kept,) = (out / NAME).read_text().splitlines()
    assert json.loads(kept)["outcome"]["mission"] == "first"
    for spoil, before in (
        (lambda: None, 1),
        (lambda: (out / "first" / "trajectory.csv").write_text("mine\n"), 0),
        (lambda: (missions / "a.yaml").write_text(GOOD.replace("mission: look", "mission: first") + "\n"), 0),
    ):
        (out / NAME).write_text(f"{kept}\n{kept[:30]}\nnull\n")
        spoil()
        done = run(*command)
        assert done.code == 0
        assert ("1 of them before this run was stopped" in done.out) is bool(before)
        assert "planned 2 of 2 missions" in done.out
        assert not (out / NAME).exists()


def _stop_after_the_first(run: Run, command: tuple[str, ...]) -> str:
    def one(work, items, _hands):
        yield work(items[0])
        raise KeyboardInterrupt

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("shotc.cli.plan_many.as_done", one)
        done = run(*command)
    assert done.code == 130
    return done.out


def test_two_missions_of_one_name_are_refused_before_anything_is_planned(run: Run, missions: Path) -> None:
    other = missions / "below" / "b.yaml"
    other.write_text(GOOD.replace("mission: look", 'mission: "first"'))
    done = run("plan", str(missions / "a.yaml"), str(other), "-o", "out", "--jobs", "1")
    assert done.code == 1
    assert "error[E115]" in done.err
    assert "b.yaml:2:10" in done.err
    assert not Path("out").exists()


def test_what_is_of_use_for_one_mission_is_refused_for_several(run: Run, missions: Path) -> None:
    for flags in (("--stop-after", "resolve"), ("--dump-ir", "resolve"), ("--time-passes",)):
        done = run("plan", str(missions), *flags)
        assert done.code == 2
        assert flags[0] in done.err
    assert run("plan", str(missions / "a.yaml"), "--workers", "tcp://127.0.0.1:9").code == 2


def test_a_process_that_is_killed_is_told(run: Run, missions: Path, monkeypatch) -> None:
    def lost(*_):
        raise parallel.Lost
        yield

    monkeypatch.setattr("shotc.cli.plan_many.as_done", lost)
    (missions / "below" / "b.yaml").unlink()
    done = run("plan", str(missions), *FAST)
    assert done.code == 1
    assert "error[W007]" in done.err


def _gone(_item: int) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


KILLED = """
import os, signal
from shotc.parallel import Lost, as_done
from tests.cli.test_plan_many import _gone
try:
    list(as_done(_gone, [1, 2], 2))
except Lost:
    print("lost")
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="there is no such signal")
def test_the_death_of_a_process_is_noticed() -> None:
    done = subprocess.run(
        [sys.executable, "-c", KILLED], capture_output=True, text=True, check=False, cwd=ROOT
    )
    assert done.stdout == "lost\n", done.stderr


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="interrupts are sent to a group of processes")
def test_an_interrupt_ends_a_batch_at_once_and_the_next_goes_on(missions: Path, tmp_path: Path) -> None:
    (missions / "below" / "b.yaml").write_text(GOOD.replace("mission: look", "mission: second"))
    for i in range(2):
        (missions / f"c{i}.yaml").write_text(GOOD.replace("mission: look", f"mission: more {i}"))
    out = tmp_path / "out"
    command = [sys.executable, "-m", "shotc", "plan", str(missions), "-o", str(out), "--jobs", "2", *FAST]
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True
    )
    while not _lines(out / NAME) and process.poll() is None:
        time.sleep(0.005)
    os.killpg(process.pid, signal.SIGINT)
    process.communicate(timeout=60)
    assert process.returncode == 130
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "planned 4 of 4 missions" in done.stdout
    assert "before this run was stopped" in done.stdout


def _lines(path: Path) -> int:
    """Return how many lines of a file are written to their end."""
    return path.read_text().count("\n") if path.exists() else 0


CLUSTER = """
from pathlib import Path
import sys
from distributed import LocalCluster
from shotc.cli import app
with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None) as here:
    sys.exit(app.run(["plan", *sys.argv[1:], "--workers", here.scheduler_address]))
"""


@pytest.mark.long
def test_a_cluster_plans_the_same(missions: Path, tmp_path: Path) -> None:
    """In a process of its own: a cluster leaves threads, and where there are threads nothing may fork."""
    pytest.importorskip("distributed")
    (missions / "below" / "b.yaml").unlink()
    there, here = tmp_path / "there", tmp_path / "here"
    for code, out in ((["-c", CLUSTER], there), (["-m", "shotc", "plan"], here)):
        command = [sys.executable, "-W", "ignore", *code, str(missions), "-o", str(out), *FAST]
        done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
        assert done.returncode == 0, done.stderr
    assert {p.name: p.read_bytes() for p in (there / "first").iterdir()} == {
        p.name: p.read_bytes() for p in (here / "first").iterdir()
    }
