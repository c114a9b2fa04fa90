"""Which of several bounds a claim names."""

from __future__ import annotations

from math import inf

import pytest

from shotc.geom.proof import ProvedExtreme
from shotc.passes.verify.claims import first_least, gap


@pytest.mark.parametrize("rounding", [-1e-12, 0.0, 1e-12, 1e-7])
def test_of_two_equal_bounds_the_first_is_named_whatever_the_rounding(rounding: float) -> None:
    bounds = [ProvedExtreme(x, x, at) for x, at in ((4.0, 1.0), (2.0, 5.0), (2.0 + rounding, 9.0))]
    found = first_least(bounds, gap(3.0))
    assert found.at == 5.0
    assert found.proven == min(2.0, 2.0 + rounding)


def test_what_is_truly_less_is_named() -> None:
    bounds = [ProvedExtreme(2.0, 2.0, 1.0), ProvedExtreme(1.99, 1.99, 2.0), ProvedExtreme(inf, inf, 3.0)]
    assert first_least(bounds, gap(3.0)) == bounds[1]
    beyond = [ProvedExtreme(1.0, 1.0, 1.0), ProvedExtreme(-inf, -inf, 2.0)]
    assert first_least(beyond, gap(3.0)) == beyond[1]
