"""Imports inside functions: those of the table in architecture.md, and no others."""

from __future__ import annotations

import re

import pytest

from tests.experiments.bench.late_imports import BY_NAME, LEAST, PACKAGE, LateImport, late_imports

ROW = re.compile(r"^\| (?:`(?P<module>[\w.]+)`|by name: .+) \| `(?P<file>[\w/]+[.]py)` \| (?P<ms>\d+) \|$")


def table() -> dict[LateImport, int]:
    page = (PACKAGE / "docs" / "architecture.md").read_text()
    section = page.partition("## Start-up\n")[2].partition("\n## ")[0]
    rows = [found for line in section.splitlines() if (found := ROW.match(line))]
    assert len(rows) == sum(line.startswith("|") for line in section.splitlines()) - 2
    return {LateImport(row["module"] or BY_NAME, row["file"]): int(row["ms"]) for row in rows}


@pytest.mark.slow
def test_every_import_inside_a_function_is_in_the_table_and_every_row_is_one():
    assert sorted(table()) == sorted(late_imports())


def test_every_import_inside_a_function_saves_enough():
    assert min(table().values()) >= LEAST
