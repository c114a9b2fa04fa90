"""plan with refiners of other packages: which is used, what they do wrong, and how long they may take."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from shotc import plugins
from tests.cli.conftest import Run
from tests.support.bad_refiners import PASS, ROUND, text
from tests.support.plugin_distributions import lay, refiner

POSIX = pytest.mark.skipif(os.name != "posix", reason="signals")
STILL = "return Outcome(path)"
NEVER = {
    "in C, with the lock held": ("import ctypes", "ctypes.PyDLL(None).sleep(600)"),
    "in C": ("import ctypes", "ctypes.CDLL(None).sleep(600)"),
    "busily": ("while True:", "    pass"),
    "deaf": ("import signal, time", "signal.signal(signal.SIGTERM, signal.SIG_IGN)", "time.sleep(600)"),
}
Install = Callable[..., None]


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Return a function that installs a refiner whose ``refine`` has some lines."""
    folder = tmp_path / "site"
    folder.mkdir()

    def laid(name: str, *lines: str, package: str = "odd-maker", source: str = "") -> None:
        lay(folder, package, name, source or refiner(name, *lines), "refiners")
        monkeypatch.delitem(sys.modules, package.replace("-", "_"), raising=False)
        plugins.forget()

    monkeypatch.syspath_prepend(str(folder))
    yield laid
    plugins.forget()


@pytest.fixture
def yard(tmp_path: Path) -> Path:
    path = tmp_path / "yard.yaml"
    path.write_text(text())
    return path


@pytest.fixture
def lenient(tmp_path: Path) -> Path:
    """The same mission, whose shots accept their convex paths."""
    path = tmp_path / "lenient.yaml"
    path.write_text(text(PASS, ROUND))
    return path


def plan(run: Run, mission: Path, *flags: str):
    return run(
        "plan", str(mission), "--emit", "csv", "--jobs", "1", "-o", str(mission.parent / "out"), *flags
    )


@pytest.fixture
def without_ours(monkeypatch: pytest.MonkeyPatch) -> None:
    names = plugins.names
    monkeypatch.setattr(plugins, "names", lambda group: [n for n in names(group) if n != "ours"])


@pytest.mark.slow
def test_without_ours_the_convex_path_is_flown_and_that_is_said(
    run: Run, good: Path, without_ours: None
) -> None:
    done = plan(run, good)
    assert done.code == 0
    assert done.err.count("warning[P007]") == 1
    assert "shotc-casadi" in done.err


def test_none_is_silent_where_it_is_asked_for(run: Run, good: Path, without_ours: None) -> None:
    done = plan(run, good, "--refiner", "none")
    assert (done.code, done.err) == (0, "")


@pytest.mark.parametrize("flags", [["--stop-after", "resolve"], ["-q"]], ids=" ".join)
def test_that_there_is_no_refiner_is_said_only_where_it_matters(
    run: Run, good: Path, without_ours: None, flags: list[str]
) -> None:
    assert plan(run, good, *flags).err == ""


def test_ours_is_used_where_it_is_installed(
    run: Run, good: Path, install: Install, monkeypatch: pytest.MonkeyPatch
) -> None:
    install("mine", "raise RuntimeError('asked')")
    monkeypatch.setattr(plugins, "usual_refiner", lambda: "mine")
    done = plan(run, good)
    assert done.code == 1
    assert "error[R001]: refiner `mine` of package odd-maker failed" in done.err
    assert "RuntimeError: asked" in done.err


def test_two_packages_with_one_refiner_are_both_named_and_neither_is_used(
    run: Run, good: Path, install: Install
) -> None:
    install("twin", STILL)
    install("twin", STILL, package="second-maker")
    done = plan(run, good, "--refiner", "twin")
    assert done.code == 1
    for word in ("error[P001]", "odd-maker", "second-maker"):
        assert word in done.err


BROKEN = {
    "raises when imported": ("raise OSError('no libfatrop.so')", "P002", "no libfatrop.so"),
    "has no name": ("PLUGIN = object()", "P002", "AttributeError"),
    "has another name": (refiner("ours", STILL), "P003", "it says name `ours`"),
    "is of another version": (refiner("odd", STILL).replace("test\", 1", "test\", 9"), "P003", "api 9"),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", BROKEN)
def test_a_refiner_that_cannot_be_loaded_is_told_with_its_package(
    run: Run, good: Path, install: Install, name: str
) -> None:
    source, code, words = BROKEN[name]
    install("odd", source=source)
    done = plan(run, good, "--refiner", "odd")
    assert done.code == 1
    for word in (f"error[{code}]", "odd-maker", words):
        assert word in done.err
    assert plan(run, good, "--refiner", "none").code == 0


@pytest.mark.slow
def test_a_refiner_that_cannot_be_loaded_does_not_matter_where_the_mission_says_so(
    run: Run, lenient: Path, install: Install
) -> None:
    install("odd", source="raise OSError('libfatrop.so: cannot open')")
    done = plan(run, lenient, "--refiner", "odd")
    assert done.code == 0
    assert done.err.count("warning[R003]") == 2
    assert "libfatrop.so: cannot open" in done.err
    assert "odd-maker" in done.err


@pytest.mark.slow
def test_a_refiner_is_told_where_it_broke_the_mission(run: Run, yard: Path, install: Install) -> None:
    lines = ("from tests.support.bad_refiners import along, bumped, returns",
             "return returns(lambda ir: bumped(ir, 'pass', along(1, -8), (0.05, 0.5)))(path)")  # fmt: skip
    install("odd", *lines)
    done = plan(run, yard, "--refiner", "odd")
    assert done.code == 1
    assert (
        "error[R006]: refiner `odd` of package odd-maker flies shot `pass` too near to zone `tree`"
        in done.err
    )
    assert "tree: {keep: out" in done.err
    assert not (yard.parent / "out").exists()


@pytest.mark.long
@pytest.mark.parametrize("name", NEVER)
@pytest.mark.timeout(60)
@POSIX
def test_a_refiner_that_takes_forever_is_stopped(run: Run, good: Path, install: Install, name: str) -> None:
    install("slow", *NEVER[name])
    done = plan(run, good, "--refiner", "slow", "--deadline", "1.5")  # which, left alone, never ends
    assert done.code == 1
    assert "error[R004]: refiner `slow` of package odd-maker was stopped after 1.5 s" in done.err


@pytest.mark.long
@POSIX
@pytest.mark.timeout(60)
def test_what_a_refiner_started_ends_with_it(run: Run, good: Path, install: Install) -> None:
    started = good.parent / "started"
    note = f"pathlib.Path({str(started)!r}).write_text(str(sleep.pid))"
    install(
        "slow",
        "import pathlib, subprocess",
        "sleep = subprocess.Popen(['sleep', '600'])",
        note,
        "sleep.wait()",
    )
    deadline = 1.5
    while not started.exists():  # on a busy machine the process may end before it has begun
        assert "error[R004]" in plan(run, good, "--refiner", "slow", "--deadline", f"{deadline:g}").err
        deadline *= 2.0
    while Path(f"/proc/{started.read_text()}/stat").exists():  # nobody's child, it is reaped by the system
        if Path(f"/proc/{started.read_text()}/stat").read_text().split()[2] == "Z":
            break
        time.sleep(0.01)


@pytest.mark.slow
@POSIX
def test_a_refiner_that_takes_forever_keeps_the_convex_path_where_it_may(
    run: Run, lenient: Path, install: Install
) -> None:
    install("slow", *NEVER["busily"])
    done = plan(run, lenient, "--refiner", "slow", "--deadline", "1")
    assert done.code == 0
    assert done.err.count("warning[R003]") == 2
    assert "was stopped after 1 s" in done.err


@pytest.mark.long
def test_a_refiner_in_time_makes_the_same_plan_in_its_own_process(
    run: Run, yard: Path, install: Install
) -> None:
    lines = ("import os, sys; print('solving', os.getpid())",
             "from tests.support.bad_refiners import along, bumped",
             "return Outcome(bumped(path, 'round', along(2, 0.2)))")  # fmt: skip
    install("odd", *lines)
    out = yard.parent / "out"
    assert plan(run, yard, "--refiner", "odd").code == 0
    here = (out / "plan.json").read_bytes()
    done = plan(run, yard, "--refiner", "odd", "--deadline", "60")
    assert done.code == 0
    assert done.err.count("warning[") == done.err.count("warning[R014]") == 1
    assert (out / "plan.json").read_bytes() == here


ENDS = {
    "raises": (["raise RuntimeError('no luck')"], "RuntimeError: no luck"),
    "exits": (["raise SystemExit(0)"], "SystemExit: 0"),
    "leaves": (["import os; os._exit(3)"], "ended with status 3 and no answer"),
    "crashes": (["import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"], "Segmentation fault"),
    "returns what cannot be sent": (["return Outcome(lambda: path)"], "local object"),
}


@pytest.mark.long
@pytest.mark.parametrize("name", ENDS)
@POSIX
def test_however_a_refiner_s_process_ends_it_is_told(
    run: Run, good: Path, install: Install, name: str
) -> None:
    lines, words = ENDS[name]
    install("odd", *lines)
    done = plan(run, good, "--refiner", "odd", "--deadline", "60")
    assert done.code == 1
    assert "error[R001]: refiner `odd` of package odd-maker failed" in done.err
    assert words in done.err


@pytest.mark.parametrize("seconds", ["0", "-1", "nan", "inf", "soon"])
def test_a_deadline_is_a_time(run: Run, good: Path, seconds: str) -> None:
    done = run("plan", str(good), "--deadline", seconds)
    assert (done.code, done.out) == (2, "")
    assert "--deadline" in done.err


@pytest.mark.long
@POSIX
@pytest.mark.timeout(60)
@pytest.mark.parametrize("flags", [[], ["--deadline", "600"]], ids=["here", "there"])
def test_an_interrupt_ends_the_refiner_too(good: Path, install: Install, flags: list[str]) -> None:
    started = good.parent / "started"
    note = f"pathlib.Path({str(started)!r}).write_text(str(os.getpid()))"
    install("slow", "import os, pathlib, time", note, "time.sleep(600)")
    command = [sys.executable, "-m", "shotc", "plan", str(good), "--jobs", "1", "--refiner", "slow", *flags]
    env = os.environ | {"PYTHONPATH": os.pathsep.join([str(good.parent / "site"), *sys.path])}
    process = subprocess.Popen(command, env=env, stderr=subprocess.PIPE, text=True, start_new_session=True)
    while not (started.exists() and started.read_text()) and process.poll() is None:
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGINT)
    _, told = process.communicate(timeout=30)
    assert (process.returncode, told) == (130, "interrupted\n")
    with pytest.raises(ProcessLookupError):
        os.kill(int(started.read_text()), 0)
