from __future__ import annotations

import os
import resource
import signal

import pytest

from shotc.emit.base import Artifact
from shotc.emit.plan_json import EMITTER
from shotc.output import earlier, write
from tests.records import replace
from tests.samples import orbit_plan

OLD = [Artifact("plan.json", b"old plan"), Artifact("trajectory.csv", b"old rows")]
NEW = [Artifact("plan.json", b"new plan"), Artifact("trajectory.csv", b"new rows " * 10_000)]


@pytest.fixture
def folder(tmp_path):
    write(OLD, tmp_path / "out")
    return tmp_path / "out"


def content(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_files_are_written_and_nothing_else_is_left(folder):
    paths, faults = write(NEW, folder)
    assert faults == ()
    assert [p.name for p in paths] == ["plan.json", "trajectory.csv"]
    assert content(folder) == {a.name: a.data for a in NEW}


def test_a_full_disk_leaves_the_old_files(folder):
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
        paths, faults = write(NEW, folder)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, ignored)
    assert paths == []
    assert [d.code for d in faults] == ["E901"]
    assert content(folder) == {a.name: a.data for a in OLD}


def test_an_interrupt_in_the_middle_leaves_the_old_files(folder, monkeypatch):
    calls = []

    def interrupted(descriptor):
        calls.append(descriptor)
        if len(calls) == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write(NEW, folder)
    assert content(folder) == {a.name: a.data for a in OLD}


def test_an_interrupt_while_renaming_waits_until_all_are_in_place(folder, monkeypatch):
    real = type(folder).replace

    def replace(self, target):
        os.kill(os.getpid(), signal.SIGINT)
        return real(self, target)

    monkeypatch.setattr(type(folder), "replace", replace)
    with pytest.raises(KeyboardInterrupt):
        write(NEW, folder)
    assert content(folder) == {a.name: a.data for a in NEW}


def test_a_file_in_the_place_of_the_folder_is_a_diagnostic(tmp_path):
    (tmp_path / "out").write_text("a file")
    paths, faults = write(NEW, tmp_path / "out")
    assert paths == []
    assert [d.code for d in faults] == ["E901"]
    assert (tmp_path / "out").read_text() == "a file"


def test_a_folder_in_the_place_of_a_file_is_a_diagnostic_and_nothing_is_written(tmp_path):
    (tmp_path / "out" / "trajectory.csv").mkdir(parents=True)
    paths, faults = write(NEW, tmp_path / "out")
    assert paths == []
    assert [d.code for d in faults] == ["E901"]
    assert [p.name for p in (tmp_path / "out").iterdir()] == ["trajectory.csv"]


def test_two_files_of_one_name_are_refused_and_nothing_is_written(folder):
    paths, faults = write([*NEW, NEW[0]], folder)
    assert paths == []
    assert [d.code for d in faults] == ["E902"]
    assert content(folder) == {a.name: a.data for a in OLD}


@pytest.mark.parametrize("name", ["look", 'a "b" \\ \u00e9'])
def test_what_an_earlier_run_left_is_found_with_its_mission(tmp_path, name):
    assert earlier(tmp_path / "nowhere") is None
    assert earlier(tmp_path) is None
    (tmp_path / "notes.txt").write_text("mine")
    assert earlier(tmp_path) is None
    (tmp_path / "cam1.waypoints").write_text("QGC WPL 110")
    (tmp_path / "cam1.plan").write_text("{}")
    assert earlier(tmp_path) == (None, ("cam1.plan", "cam1.waypoints"))
    plan = orbit_plan()
    keyframes = replace(
        plan.trajectory.keyframes, mission=replace(plan.trajectory.keyframes.mission, name=name)
    )
    named = replace(plan, trajectory=replace(plan.trajectory, keyframes=keyframes))
    (tmp_path / "plan.json").write_bytes(EMITTER.emit(named).artifacts[0].data)
    assert earlier(tmp_path) == (name, ("plan.json", "cam1.plan", "cam1.waypoints"))


@pytest.mark.parametrize("data", [b"", b"{", b"\xff\xfe", b'{"mission": {"name": 3}}'])
def test_a_plan_that_is_none_is_told_without_its_mission(tmp_path, data):
    (tmp_path / "plan.json").write_bytes(data)
    assert earlier(tmp_path) == (None, ("plan.json",))
