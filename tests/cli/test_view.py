"""view: what it hands to the viewer, and what it says where there is none."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from shotc.cli import view
from shotc.emit.plan_json import EMITTER
from shotc.ir.passes import PassContext
from shotc.passes.verify import Verify
from tests.cli.conftest import Run
from tests.support.film_plans import orbit_plan


@dataclass
class Viewer:
    """Stands in for the viewer's process: keeps what it was given."""

    status: int = 0
    command: list[str] = field(default_factory=list)
    data: bytes = b""

    def __call__(self, command: Sequence[str], *, check: bool) -> subprocess.CompletedProcess[bytes]:
        assert not check
        self.command = list(command)
        self.data = Path(command[-1]).read_bytes()
        return subprocess.CompletedProcess(self.command, self.status)


@pytest.fixture
def viewer(monkeypatch: pytest.MonkeyPatch) -> Viewer:
    stand_in = Viewer()
    monkeypatch.setattr(subprocess, "run", stand_in)
    monkeypatch.setenv("DISPLAY", ":0")
    return stand_in


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    verified = Verify().run(orbit_plan().trajectory, PassContext()).value
    assert verified is not None
    path = tmp_path / "out" / "plan.json"
    path.parent.mkdir()
    path.write_bytes(EMITTER.emit(verified).artifacts[0].data)
    return path


@pytest.mark.slow
def test_a_plan_is_shown_and_nothing_is_left_behind(run: Run, viewer: Viewer, plan: Path) -> None:
    for place in (plan, plan.parent):
        done = run("view", str(place))
        assert (done.code, done.out) == (0, "")
        assert viewer.data[:4] == b"RRF2"
        assert viewer.command[0] == sys.executable
        assert viewer.command[viewer.command.index("--bind") + 1] == "127.0.0.1"
        assert not Path(viewer.command[-1]).parent.exists()
        assert [path.name for path in plan.parent.iterdir()] == ["plan.json"]


@pytest.mark.slow
def test_a_mission_is_planned_and_shown(run: Run, viewer: Viewer, good: Path) -> None:
    done = run("view", str(good))
    assert done.code == 0, done.err
    assert viewer.data[:4] == b"RRF2"
    assert [path.name for path in good.parent.iterdir()] == ["good.yaml"]


def test_a_rejected_mission_is_not_shown(run: Run, viewer: Viewer, good: Path) -> None:
    good.write_text(good.read_text().replace("target: tower", "target: towre"))
    done = run("view", str(good))
    assert done.code == 1
    assert "`tower`" in done.err
    assert viewer.command == []


def test_a_plan_that_cannot_be_read(run: Run, viewer: Viewer, tmp_path: Path) -> None:
    done = run("view", str(tmp_path / "none.json"))
    assert done.code == 1
    assert "cannot be read" in done.err
    assert viewer.command == []


@pytest.mark.slow
def test_a_viewer_that_fails(run: Run, viewer: Viewer, plan: Path) -> None:
    viewer.status = 3
    done = run("view", str(plan))
    assert done.code == 1
    assert "error[E203]" in done.err
    assert "exit status is 3" in done.err


@pytest.mark.skipif(sys.platform != "linux", reason="only there a display is named by the environment")
def test_without_a_display_it_says_what_to_do(
    run: Run, viewer: Viewer, good: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("DISPLAY")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    done = run("view", str(good))
    assert done.code == 1
    assert "error[E202]" in done.err
    assert "rerun --web-viewer mission.rrd" in done.err
    assert viewer.command == []


def test_without_the_viewer_it_says_what_to_install(
    run: Run, viewer: Viewer, good: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(view, "find_spec", lambda _name: None)
    done = run("view", str(good))
    assert done.code == 1
    assert "error[E201]" in done.err
    assert "pip install" in done.err
    assert "[view]" in done.err
    assert viewer.command == []
