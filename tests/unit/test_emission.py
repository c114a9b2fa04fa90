"""Workers that emit: what they make is what one process makes, and none of them outlives its crew."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from traceback import extract_tb
from typing import ClassVar

import pytest

from shotc.emission import emitter_pool, usual_jobs
from shotc.emit.base import Artifact, Emission

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="workers are forked on Linux only")
HERE = os.getpid()


@dataclass
class Light:
    name: str
    summary = "says where it ran"
    api = 1

    def emit(self, plan):
        return Emission((Artifact(self.name, f"{plan} by {os.getpid()}".encode()),), notes=(self.name,))


@dataclass
class Heavy(Light):
    def prepare(self):
        """Nothing to load."""


class Together(Heavy):
    """Waits until every worker prepares something, so that none can do the work of two."""

    met = None
    waited: ClassVar[set[int]] = set()

    def prepare(self):
        if self.met is not None and os.getpid() not in self.waited:
            self.waited.add(os.getpid())
            self.met.wait(60)


class Broken(Heavy):
    def emit(self, plan):
        raise ValueError(f"{self.name} cannot do {plan}")


class Wordy(Heavy):
    def emit(self, plan):
        return f"{plan} is done"


class Lacking(Heavy):
    def prepare(self):
        self.emit("")

    def emit(self, plan):
        raise ModuleNotFoundError("No module named 'rerun'", name="rerun")


class Deadly(Heavy):
    def emit(self, plan):
        if os.getpid() != HERE:
            os.kill(os.getpid(), signal.SIGKILL)
        return super().emit(plan)


class Stillborn(Heavy):
    def prepare(self):
        os.kill(os.getpid(), signal.SIGKILL)


class Unsendable(Heavy):
    def emit(self, plan):
        return Emission((Artifact(self.name, b"made"),), notes=(lambda: None,))


def emitted(emitters, jobs, plan="plan"):
    known = {emitter.name: emitter for emitter in emitters}
    with emitter_pool(jobs, known.get) as hands:
        hands.prepare(list(known))
        return hands.emit(plan, emitters)


def maker(outcome):
    return int(outcome.artifacts[0].data.split()[-1])


def children():
    text = Path(f"/proc/self/task/{threading.get_native_id()}/children").read_text()
    return [int(pid) for pid in text.split()]


@pytest.fixture(autouse=True)
def no_other_thread():
    """A crew forks no workers while a thread of an earlier test, such as that of a pool, still ends."""
    for thread in threading.enumerate():
        if thread is not threading.current_thread():
            thread.join(30)


@pytest.mark.parametrize("jobs", [1, 2, 3, 4])
def test_results_come_in_the_order_of_the_emitters_and_every_worker_has_some(jobs, monkeypatch):
    emitters = [Together("a"), Light("b"), Together("c"), Light("d"), Together("e")]
    monkeypatch.setattr(Together, "met", get_context("fork").Barrier(jobs - 1) if jobs > 1 else None)
    outcomes = emitted(emitters, jobs)
    assert [outcome.notes for outcome in outcomes] == [("a",), ("b",), ("c",), ("d",), ("e",)]
    assert all(outcome.artifacts[0].data.startswith(b"plan by ") for outcome in outcomes)
    makers = [maker(outcome) for outcome in outcomes]
    assert makers[1] == makers[3] == HERE
    away = {makers[0], makers[2], makers[4]}
    assert len(away) == max(1, jobs - 1)
    assert (HERE in away) == (jobs == 1)


def test_big_plans_and_big_results_pass():
    (outcome, _) = emitted([Heavy("a"), Light("b")], 2, "x" * 5_000_000)
    assert len(outcome.artifacts[0].data) > 5_000_000
    assert maker(outcome) != HERE


def test_a_failure_in_a_worker_is_an_outcome_with_its_trace():
    good, bad = emitted([Heavy("good"), Broken("bad")], 2)
    assert isinstance(good, Emission)
    assert isinstance(bad, ValueError)
    assert str(bad) == "bad cannot do plan"
    assert extract_tb(bad.__traceback__)[-1].name == "emit"
    assert children() == []


def test_an_answer_that_is_no_emission_is_an_outcome():
    good, wordy = emitted([Heavy("good"), Wordy("wordy")], 2)
    assert isinstance(good, Emission)
    assert wordy == "returned a str, not an Emission"


def test_a_missing_library_is_an_outcome():
    good, lacking = emitted([Heavy("good"), Lacking("rerun")], 3)
    assert isinstance(good, Emission)
    assert isinstance(lacking, ModuleNotFoundError)
    assert lacking.name == "rerun"


@pytest.mark.slow
@pytest.mark.parametrize("kind", [Deadly, Stillborn, Unsendable])
@pytest.mark.parametrize("jobs", [2, 3])
def test_what_a_worker_does_not_bring_back_is_made_here(kind, jobs):
    lost, other = emitted([kind("lost"), Heavy("other")], jobs, "x" * 5_000_000)
    assert lost.artifacts[0].name == "lost"
    assert other.notes == ("other",)


def test_what_was_not_prepared_is_made_here():
    with emitter_pool(3, {}.get) as hands:
        hands.prepare(["nobody knows"])
        (outcome,) = hands.emit("plan", [Heavy("a")])
    assert maker(outcome) == HERE


@pytest.mark.slow
def test_no_worker_outlives_its_crew():
    with emitter_pool(4, {}.get):
        assert len(children()) == 3
    assert children() == []

    def interrupted():
        with emitter_pool(3, {}.get) as hands:
            hands.prepare([])
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert children() == []


def test_an_interrupt_from_the_terminal_leaves_workers_to_their_crew():
    known = {"a": Heavy("a")}
    with emitter_pool(2, known.get) as hands:
        hands.prepare(["a"])
        (worker,) = children()
        os.kill(worker, signal.SIGINT)
        (outcome,) = hands.emit("plan", [known["a"]])
    assert maker(outcome) == worker


def test_no_fork_beside_threads():
    done = threading.Event()
    thread = threading.Thread(target=done.wait)
    thread.start()
    try:
        with emitter_pool(3, {}.get):
            assert children() == []
    finally:
        done.set()
        thread.join()


ORPHANS = """
import os, signal
from shotc.emission import emitter_pool
with emitter_pool(3, {}.get):
    print(open(f"/proc/self/task/{os.getpid()}/children").read(), flush=True)
    os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.timeout(120)  # workers that outlive it would be waited for without end
def test_workers_end_when_the_process_is_killed():
    run = subprocess.run([sys.executable, "-c", ORPHANS], check=False, capture_output=True, text=True)
    workers = run.stdout.split()
    assert run.returncode == -signal.SIGKILL
    assert len(workers) == 2

    def alive(pid):
        stat = Path(f"/proc/{pid}/stat")
        return stat.exists() and stat.read_text().rpartition(")")[2].split()[0] != "Z"

    while any(map(alive, workers)):
        time.sleep(0.01)


def test_usual_jobs_are_few():
    assert 1 <= usual_jobs() <= 4
