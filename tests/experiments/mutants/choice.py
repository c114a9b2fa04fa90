"""A pytest plugin that runs chosen tests in a chosen order: ``-p tests.experiments.mutants.choice``."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import Phase, settings

CHOSEN = "MUTANTS_TESTS"
"""Environment: a file with the ids of the tests, one a line."""

FAILED = "MUTANTS_FAILED"
"""Environment: a file to which the ids of the tests that fail are added."""


def pytest_configure() -> None:
    """Let hypothesis look for counterexamples, not for short ones."""
    settings.register_profile("mutants", settings(), phases=(Phase.explicit, Phase.generate))
    settings.load_profile("mutants")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Leave the chosen tests, in their order."""
    chosen = Path(os.environ[CHOSEN]).read_text(encoding="utf-8").split("\n")
    place = {name: i for i, name in enumerate(chosen)}
    items[:] = sorted((i for i in items if i.nodeid in place), key=lambda i: place[i.nodeid])


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Write down what fails."""
    if report.failed:
        with Path(os.environ[FAILED]).open("a", encoding="utf-8") as file:
            file.write(f"{report.nodeid}\n")
