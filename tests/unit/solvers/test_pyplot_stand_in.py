"""What stands in for pyplot while toppra loads: it is empty until then, and pyplot itself after it."""

from __future__ import annotations

import sys
from types import ModuleType

import pytest

from shotc.solvers.topp_ra import PYPLOT, late_pyplot


def test_a_module_that_is_absent_is_one_that_loads_later(monkeypatch: pytest.MonkeyPatch) -> None:
    library, pyplot = ModuleType("matplotlib"), ModuleType(PYPLOT)
    vars(pyplot)["Figure"] = object()
    monkeypatch.setitem(sys.modules, "matplotlib", library)
    monkeypatch.delitem(sys.modules, PYPLOT, raising=False)
    with late_pyplot():
        assert sys.modules["matplotlib"] is library
        stand_in = sys.modules[PYPLOT]
        assert not hasattr(stand_in, "Figure")
    assert sys.modules["matplotlib"] is library
    assert PYPLOT not in sys.modules
    monkeypatch.setitem(sys.modules, PYPLOT, pyplot)
    assert stand_in.Figure is pyplot.Figure


def test_a_module_that_is_there_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    pyplot = ModuleType(PYPLOT)
    monkeypatch.setitem(sys.modules, PYPLOT, pyplot)
    with late_pyplot():
        assert sys.modules[PYPLOT] is pyplot
    assert sys.modules[PYPLOT] is pyplot
