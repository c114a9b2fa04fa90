"""plan --jobs: the same files however many make them, and a clean end at any moment."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

PLAN = [sys.executable, "-m", "shotc", "plan", "--refiner", "none"]
LINUX = pytest.mark.skipif(sys.platform != "linux", reason="workers are forked on Linux only")


def files(good: Path, folder: Path, *flags: str) -> dict[str, bytes]:
    command = [*PLAN, str(good), "-o", str(folder), *flags]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.mark.long
def test_jobs_do_not_change_the_files(good: Path, tmp_path: Path) -> None:
    emit = ("--emit", "storyboard,csv,rerun")
    alone = files(good, tmp_path / "one", "--jobs", "1", *emit)
    together = files(good, tmp_path / "three", "--jobs", "3", *emit)
    assert set(alone) == set(together)
    # A recording holds identities that rerun draws anew.
    assert len(alone.pop("mission.rrd")) == pytest.approx(len(together.pop("mission.rrd")), rel=0.01)
    assert alone == together


@pytest.mark.long
@pytest.mark.parametrize("jobs", ["0", "-1", "two"])
def test_jobs_are_a_number(good: Path, jobs: str) -> None:
    done = subprocess.run([*PLAN, str(good), "--jobs", jobs], check=False, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert "--jobs" in done.stderr


@pytest.mark.long
@LINUX
@pytest.mark.parametrize("wait", [0.0, 0.2, 0.4])
def test_an_interrupt_ends_the_workers_too(good: Path, tmp_path: Path, wait: float) -> None:
    folder = tmp_path / "out"
    command = [*PLAN, str(good), "-o", str(folder), "--jobs", "3"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True)
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    workers: list[str] = []
    while len(workers) < 2 and process.poll() is None:
        workers = children.read_text().split() if children.exists() else []
        time.sleep(0.002)
    time.sleep(wait)
    os.killpg(process.pid, signal.SIGINT)
    _, told = process.communicate(timeout=60)
    assert process.returncode == 130, told
    assert told.strip().endswith("interrupted")
    assert not folder.exists()
    with pytest.raises(ProcessLookupError):
        os.killpg(process.pid, 0)
