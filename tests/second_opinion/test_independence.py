"""The second opinion is nobody else's: it imports nothing of the compiler but its door."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

HERE = Path(__file__).parents[1] / "support" / "second_opinion"
DOOR = {"compiled.py": {"shotc", "tests"}}
"""Missions go in and bytes come out there."""
OUTSIDE = {"numpy", "scipy", "yaml", "pymap3d", "pytest"}
OURS = {"tests.support.second_opinion", "tests.support.generated.missions"}


def imported(path: Path) -> set[str]:
    """Return the modules that a file imports anywhere in it."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "a relative import hides where it leads"
            found.add(str(node.module))
    return found


@pytest.mark.parametrize("path", sorted(HERE.glob("*.py")), ids=lambda path: path.name)
def test_a_file_imports_libraries_and_its_neighbours_only(path: Path) -> None:
    modules = {name for name in imported(path) if not name.startswith(tuple(OURS))}
    strange = {name.split(".")[0] for name in modules} - OUTSIDE - DOOR.get(path.name, set())
    standard = {"shotc", "tests"} & strange
    assert not standard, modules


def test_the_door_is_the_public_interface() -> None:
    source = (HERE / "compiled.py").read_text(encoding="utf-8")
    assert {name for name in imported(HERE / "compiled.py") if name.startswith("shotc")} == {"shotc"}
    assert "from shotc import api\n" in source
    assert not [word for word in ("importlib", "__import__", "exec(") if word in source]
