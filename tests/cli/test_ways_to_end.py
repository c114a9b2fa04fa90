"""Exit statuses and streams of the command as a whole."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from shotc import __version__
from shotc.cli import app, check
from tests.cli.conftest import Run

SHOTC = [sys.executable, "-m", "shotc"]
MORE_THAN_A_PIPE_HOLDS = 200_000  # bytes


def test_version_is_one_line(run: Run) -> None:
    assert run("--version").out == f"shotc {__version__}\n"


@pytest.mark.slow
def test_help_teaches(run: Run) -> None:
    result = run("--help")
    assert result.code == 0
    for word in ("Write missions", "From mission to flight", "shotc new", "Exit status", *app.COMMANDS):
        assert word in result.out


@pytest.mark.parametrize("name", app.COMMANDS)
def test_every_command_has_help_with_an_example(run: Run, name: str) -> None:
    result = run(name, "--help")
    assert result.code == 0
    assert f"shotc {name}" in result.out.replace("Usage: shotc", "")


def test_nothing_asked_is_a_usage_error(run: Run) -> None:
    result = run()
    assert (result.code, result.out) == (2, "")


@pytest.mark.parametrize(
    "arguments",
    [
        ["chekc", "x"],
        ["check"],
        ["check", "--format", "xml", "x"],
        ["--color", "blue", "schema"],
        ["--no-such"],
    ],
    ids=["command", "argument", "format", "color", "flag"],
)
def test_usage_errors(run: Run, arguments: list[str]) -> None:
    result = run(*arguments)
    assert (result.code, result.out) == (2, "")
    assert result.err.startswith("error: ")
    assert "--help`" in result.err


def test_our_bug_is_a_diagnostic(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise RuntimeError("wheels fell off")

    monkeypatch.setattr(check, "gather", fail)
    result = run("check", "x.yaml", "--quiet")
    assert (result.code, result.out) == (70, "")
    assert result.err.startswith("error[X001]: shotc failed")
    assert "RuntimeError: wheels fell off" in result.err
    assert "SHOTC_DEBUG=1" in result.err
    assert "Traceback" not in result.err
    monkeypatch.setenv("SHOTC_DEBUG", "1")
    assert "Traceback" in run("check", "x.yaml").err


@pytest.mark.parametrize(("library", "extra"), [("numpy", "plan"), ("rerun.blueprint", "view")])
def test_a_missing_library_is_told_with_the_extra_that_brings_it(
    run: Run, monkeypatch: pytest.MonkeyPatch, library: str, extra: str
) -> None:
    def lack(*_: object) -> None:
        raise ModuleNotFoundError(f"No module named '{library}'", name=library)

    monkeypatch.setattr(check, "gather", lack)
    result = run("check", "x.yaml")
    assert (result.code, result.out) == (1, "")
    assert result.err.startswith(f"error[P004]: this command needs {library}")
    assert f"[{extra}]'`" in result.err


def test_interrupt(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(check, "gather", interrupt)
    result = run("check", "x.yaml")
    assert (result.code, result.out, result.err) == (130, "", "interrupted\n")


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_interrupt_of_a_process() -> None:
    process = subprocess.Popen([*SHOTC, "check", "-"], stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdin is not None
    process.stdin.write(b"#" * MORE_THAN_A_PIPE_HOLDS)  # returns once the command reads
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=20)
    assert (process.returncode, err) == (130, b"interrupted\n")


def test_an_interrupt_while_the_command_line_loads() -> None:
    code = (
        "import sys\n"
        "class Stop:\n"
        "    def find_spec(self, name, path=None, target=None):\n"
        "        if name == 'shotc.cli.app': raise KeyboardInterrupt\n"
        "sys.meta_path.insert(0, Stop())\n"
        "from shotc.__main__ import main\n"
        "main()\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (130, b"interrupted\n")


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="pipes")
def test_a_closed_pipe_is_quiet() -> None:
    process = subprocess.Popen([*SHOTC, "explain"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout is not None
    process.stdout.close()
    assert process.stderr is not None
    err = process.stderr.read()
    assert (process.wait(timeout=20), err) == (141, b"")


@pytest.mark.slow
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk_is_said() -> None:
    with Path("/dev/full").open("wb") as full:
        done = subprocess.run([*SHOTC, "explain"], stdout=full, stderr=subprocess.PIPE, check=False)
    assert done.returncode == 1
    assert done.stderr.startswith(b"standard output cannot be written: ")


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="file descriptors")
def test_closed_streams() -> None:
    done = subprocess.run(["sh", "-c", f"exec {sys.executable} -m shotc explain >&- 2>&-"], check=False)
    assert done.returncode == 0
