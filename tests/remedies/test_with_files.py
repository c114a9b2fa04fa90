"""Helps about files that a mission names: each remedy is written into the mission, or into the file."""

from __future__ import annotations

from pathlib import Path

import pytest

from shotc.diag.model import Diagnostic
from tests.support.front_passes import placed
from tests.support.remedies.tried import failed
from tests.support.remedies.with_files import CASES, Case

pytestmark = pytest.mark.slow


def write(folder: Path, files: dict[str, bytes]) -> None:
    for name, data in files.items():
        (folder / name).write_bytes(data)


@pytest.mark.long
@pytest.mark.parametrize("case", CASES, ids=[f"{case.code}-{i}" for i, case in enumerate(CASES)])
def test_what_a_help_proposes_does_when_it_is_written(case: Case, tmp_path: Path) -> None:
    def judged(text: str) -> list[Diagnostic]:
        return placed(text.encode(), tmp_path)[1]

    write(tmp_path, case.files)
    assert case.code in {fault.code for fault in judged(case.mission)}
    if case.mended is None:
        found, wrong = failed(case.mission, judged)
        assert found
        assert wrong == []
    else:
        write(tmp_path, case.mended)
        assert judged(case.mission) == []
