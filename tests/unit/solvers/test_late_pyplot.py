"""toppra without pyplot: nothing of matplotlib is loaded for it, and it is there when it is used."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytestmark = pytest.mark.slow

pytest.importorskip("toppra", reason="it has wheels for Linux x86-64 only", exc_type=ModuleNotFoundError)

SEEN = """
import sys{before}
from shotc.solvers import topp_ra
topp_ra.load()
print("matplotlib.pyplot" in sys.modules)
from toppra.algorithm import algorithm
print(algorithm.plt.Figure.__module__)
import matplotlib.pyplot as plt
print(plt.Figure is algorithm.plt.Figure, plt.__spec__ is not None)
"""


@pytest.mark.long
@pytest.mark.parametrize("before", ["", ", matplotlib"])
def test_pyplot_loads_when_it_is_used(before: str) -> None:
    run = subprocess.run(
        [sys.executable, "-c", SEEN.format(before=before)], check=False, capture_output=True, text=True
    )
    assert run.stdout.split() == ["False", "matplotlib.figure", "True", "True"], run.stderr


@pytest.mark.long
def test_a_pyplot_that_is_there_is_left_alone() -> None:
    code = SEEN.format(before=", matplotlib.pyplot")
    run = subprocess.run([sys.executable, "-c", code], check=False, capture_output=True, text=True)
    assert run.stdout.split() == ["True", "matplotlib.figure", "True", "True"], run.stderr
