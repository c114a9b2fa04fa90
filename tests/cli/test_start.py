"""What a process of the command loads: whoever waits for `check` waits for every module of it."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib.metadata import entry_points

import pytest

from shotc.plugins import OPTIONAL

SCRIPT = """
import json, os, sys
os._exit = sys.exit
sys.argv = ["shotc", *{arguments}]
from shotc.__main__ import main
try:
    main()
except SystemExit as end:
    print(json.dumps([end.code, sorted(sys.modules)]), file=sys.__stdout__)
"""


def start(*arguments: str) -> tuple[int, set[str]]:
    """Run a command line in a process of its own; return its exit status and the modules it loaded."""
    script = SCRIPT.format(arguments=arguments)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    code, modules = json.loads(done.stdout.splitlines()[-1])
    return code, set(modules)


@pytest.fixture(scope="module")
def checked(tmp_path_factory) -> set[str]:
    """The modules that a clean check of one orbit loads."""
    path = tmp_path_factory.mktemp("start") / "orbit.yaml"
    path.write_text(
        "shotc: 1\nmission: start\ntargets: {tower: {at: [0, 0, 10], radius: 3, height: 20}}\n"
        "drones: {cam: {model: x500, home: [0, -60, 0]}}\n"
        "shots: [{id: round, kind: orbit, drone: cam, target: tower, radius: 40, altitude: 12}]\n"
    )
    code, modules = start("check", str(path))
    assert code == 0
    return modules


@pytest.mark.slow
def test_check_loads_the_kinds_that_the_mission_uses_and_no_others(checked):
    kinds = {entry.module for entry in entry_points(group="shotc.kinds")}
    assert len(kinds) > 10
    assert kinds & checked == {"shotc.kinds.orbit"}


def test_check_loads_no_other_command(checked):
    commands = {name for name in checked if name.startswith("shotc.cli.")}
    assert commands == {"shotc.cli.app", "shotc.cli.check", "shotc.cli.console", "shotc.cli.inputs"}


def test_check_loads_nothing_that_prints_plans_emits_or_makes_schemas(checked):
    late = ("rich", "shotc.diag.render", "shotc.emit", "shotc.solvers", "shotc.spec.schema")
    assert not [name for name in checked for start in late if name == start or name.startswith(f"{start}.")]


def test_check_of_a_film_loads_nothing_of_shows(checked):
    shows = ("shotc.show", "shotc.ir.show", "shotc.ir.effects", "shotc.kinds.pictures", "shotc.kinds.effects")
    assert not [name for name in checked for start in shows if name == start or name.startswith(f"{start}.")]


@pytest.mark.long
def test_the_help_of_all_commands_needs_the_base_install_only():
    code, modules = start("--help")
    assert (code, modules & set(OPTIONAL)) == (0, set())


def test_the_version_loads_no_compiler():
    code, modules = start("--version")
    assert code == 0
    assert "shotc.api" not in modules
    assert "yaml" not in modules
