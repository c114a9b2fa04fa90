"""Distributions of a test's own, laid on sys.path for one test."""

from __future__ import annotations

import sys

import pytest

from shotc import plugins
from tests.support.plugin_distributions import lay


@pytest.fixture
def install(tmp_path, monkeypatch):
    """Lay a distribution with one emitter, or another plugin, on sys.path."""

    def laid(distribution: str, entry: str, body: str, group: str = "emitters") -> None:
        lay(tmp_path, distribution, entry, body, group)
        monkeypatch.delitem(sys.modules, distribution.replace("-", "_"), raising=False)

    monkeypatch.syspath_prepend(str(tmp_path))
    plugins.forget()
    yield laid
    plugins.forget()
