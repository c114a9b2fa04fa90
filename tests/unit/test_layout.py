"""The layout of the unit tests mirrors that of the package."""

from __future__ import annotations

from pathlib import Path

HERE = Path(__file__).parent
PACKAGE = HERE.parents[1] / "shotc"
OTHERS = {"diag/golden", "experiments"}
"""What tests compare with, and the tests of `tests/experiments`."""


def test_every_folder_of_tests_has_the_package_that_it_tests() -> None:
    # A folder that was moved away may still hold compiled modules.
    files = (path for path in HERE.rglob("*") if path.is_file() and path.suffix != ".pyc")
    tested = {path.parent.relative_to(HERE).as_posix() for path in files} - OTHERS
    assert len(tested) > 40
    assert [f for f in sorted(tested) if not (PACKAGE / f).is_dir()] == []


def test_tests_of_a_pass_stand_in_its_folder() -> None:
    assert list((HERE / "passes").glob("*.py")) == []
