"""``shotc check``: inputs, formats, streams and exit codes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import GOOD, Run

BAD = GOOD.replace("mission: look", "mission: look\nmission: again")


def test_a_clean_mission(run: Run, good: Path) -> None:
    result = run("check", good.name)
    assert (result.code, result.out, result.err) == (0, "", "checked 1 mission: no errors\n")


def test_a_rejected_mission(run: Run) -> None:
    Path("bad.yaml").write_text(BAD)
    result = run("check", "bad.yaml")
    assert result.code == 1
    assert result.out.startswith(
        "error[Y012]: the key 'mission' stands here a second time\n --> bad.yaml:3:1\n"
    )
    assert result.out.endswith("1 error found\n")
    assert result.err == "checked 1 mission\n"
    assert "\x1b" not in result.out


def test_quiet_says_nothing_of_a_clean_mission(run: Run, good: Path) -> None:
    for arguments in (["-q", "check", good.name], ["check", good.name, "--quiet"]):
        result = run(*arguments)
        assert (result.code, result.out, result.err) == (0, "", "")


def test_several_files_are_one_report(run: Run, good: Path) -> None:
    for name in ("b.yaml", "a.yaml"):
        Path(name).write_text(BAD)
    result = run("check", "b.yaml", "a.yaml", good.name, "./b.yaml", "--format", "concise")
    assert [line.split(":")[0] for line in result.out.splitlines()] == ["a.yaml", "b.yaml"]
    assert result.code == 1


def test_standard_input(run: Run) -> None:
    assert run("check", "-", stdin=GOOD.encode()).code == 0
    result = run("check", "-", "--format", "concise", stdin=BAD.encode())
    assert result.out.startswith("<stdin>:3:1: Y012 ")
    result = run("check", "-", "--stdin-filename", "x/y.yaml", "--format", "concise", stdin=b"\xff")
    assert result.out.startswith("x/y.yaml:1:1: Y001 ")


def test_a_missing_file_is_a_diagnostic(run: Run) -> None:
    result = run("check", "none.yaml", "--format", "json")
    assert result.code == 1
    (found,) = json.loads(result.out)["diagnostics"]
    assert (found["code"], found["file"], found["line"], found["column"]) == ("Y022", "none.yaml", 1, 1)
    assert found["message"] == "the file cannot be read: no such file or directory"


def test_a_name_no_file_can_have(run: Run) -> None:
    result = run("check", "x" * 5000, "--format", "concise")
    assert result.code == 1
    assert " Y022 the file cannot be read: " in result.out


@pytest.mark.slow
def test_closed_standard_input() -> None:
    command = f"exec {sys.executable} -m shotc check - --format concise <&-"
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (1, "<stdin>:1:1: Y015 the file holds no mission\n")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="a superuser reads everything")
def test_a_folder_that_may_not_be_read(run: Run) -> None:
    Path("m/locked").mkdir(parents=True, mode=0o755)
    Path("m/locked").chmod(0)
    result = run("check", "m", "--format", "concise")
    assert result.code == 1
    assert "m/locked:1:1: Y022 the folder cannot be read" in result.out


def test_a_folder_is_searched_for_missions(run: Run) -> None:
    texts = {
        "m/a.yaml": GOOD,
        "m/deep/b.yml": BAD,
        "m/c.yaml": '{\n  "shotc": 1}\n',
        "m/compose.yaml": "services: {shotc: 1}\n",
        "m/.hidden/d.yaml": BAD,
        "m/notes.txt": BAD,
    }
    for name, text in texts.items():
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).write_text(text)
    result = run("check", "m", "m/a.yaml", "--format", "concise")
    assert {line.split(":")[0] for line in result.out.splitlines()} == {"m/deep/b.yml", "m/c.yaml"}
    assert result.err == "checked 3 missions; passed over 1 YAML file without a top-level key `shotc`\n"


def test_a_folder_without_missions_is_an_error(run: Run) -> None:
    Path("empty").mkdir()
    Path("empty/other.yaml").write_text("a: 1\n")
    result = run("check", "empty")
    assert result.code == 1
    assert "error[Y023]: the folder holds no mission" in result.out


def test_a_file_by_name_is_checked_whatever_it_holds(run: Run) -> None:
    Path("other.yaml").write_text("a: 1\n")
    assert run("check", "other.yaml").code == 1


@pytest.mark.parametrize("name", ["json", "sarif"])
def test_documents_stand_alone_even_without_findings(run: Run, good: Path, name: str) -> None:
    result = run("check", good.name, "--format", name)
    assert result.code == 0
    assert result.err == ""
    document = json.loads(result.out)
    assert (document.get("diagnostics") or document.get("runs", [{}])[0].get("results") or []) == []


def test_the_json_contract(run: Run) -> None:
    Path("bad.yaml").write_text(BAD)
    document = json.loads(run("check", "bad.yaml", "--format", "json").out)
    assert document == {
        "diagnostics": [
            {
                "code": "Y012",
                "slug": "duplicate-key",
                "severity": "error",
                "message": "the key 'mission' stands here a second time",
                "file": "bad.yaml",
                "line": 3,
                "column": 1,
                "end_line": 3,
                "end_column": 8,
                "notes": ["first given on line 2"],
                "help": "keep one of the two",
            }
        ],
        "summary": {"errors": 1, "warnings": 0, "files": 1},
    }


def test_github_is_the_default_in_a_workflow(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("bad.yaml").write_text(BAD)
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    assert run("check", "bad.yaml").out.startswith("::error title=Y012 duplicate-key,file=bad.yaml,line=3,")
    assert run("check", "bad.yaml", "--format", "text").out.startswith("error[Y012]")


def test_colour(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("bad.yaml").write_text(BAD)
    red = "\x1b[1;31merror[Y012]"
    assert red in run("--color", "always", "check", "bad.yaml").out
    assert red in run("check", "bad.yaml", "--color=always").out
    monkeypatch.setenv("FORCE_COLOR", "1")
    assert red in run("check", "bad.yaml").out
    assert "\x1b" not in run("check", "bad.yaml", "--color", "never").out
    monkeypatch.setenv("NO_COLOR", "1")
    assert "\x1b" not in run("check", "bad.yaml").out


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xff\xfe",
        b"\x00" * 99,
        b"[" * 20_000,
        b"a: &a [*a]",
        b"- x",
        b"a: !!python/name:x",
        b"\t",
        b"x: .nan",
    ],
    ids=["empty", "utf-16", "nul", "deep", "recursive", "list", "tag", "tab", "nan"],
)
def test_bad_bytes_are_rejected_without_traceback(run: Run, data: bytes) -> None:
    Path("bad.yaml").write_bytes(data)
    result = run("check", "bad.yaml", "--format", "json")
    assert result.code == 1
    lines = [found["line"] for found in json.loads(result.out)["diagnostics"]]
    assert lines
    assert min(lines) >= 1
    assert "Traceback" not in result.err


@pytest.mark.slow
def test_check_loads_nothing_heavy(good: Path) -> None:
    heavy = ["numpy", "scipy", "cvxpy", "clarabel", "toppra", "rerun", "matplotlib", "casadi"]
    code = (
        "import sys; from shotc.cli.app import run\n"
        f"code = run(['check', {str(good)!r}])\n"
        f"print(code, sorted(set({heavy}) & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "0 []\n"


@pytest.mark.slow
def test_check_defines_no_dataclasses(good: Path) -> None:
    code = (
        "import sys; from shotc.cli.app import run\n"
        f"code = run(['check', {str(good)!r}])\n"
        "ours = {name: vars(module) for name, module in sys.modules.items() if name.startswith('shotc')}\n"
        "held = [item for members in ours.values() for item in members.values()]\n"
        "data = [item for item in held if hasattr(item, '__dataclass_fields__')]\n"
        "print(code, [item for item in data if item.__module__ in ours])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "0 []\n"
