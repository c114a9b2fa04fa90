"""A refined path that is taken breaks nothing in space: whatever was done to it, verification agrees."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st

from shotc.ir.passes import PassContext
from shotc.passes.parameterize_time import ParameterizeTime
from shotc.passes.verify import Verify
from tests.support.bad_refiners import PASS, ROUND, bumped, path, refine, returns

pytestmark = pytest.mark.slow

GEOMETRY = {"V005", "V007", "V008", "V009", "V010", "V011", "V016", "V017", "V018"}
"""What is broken by where a path leads and not by when."""

SHARES = st.sampled_from([0.0, 0.1, 0.25, 0.4, 0.5, 0.6, 0.75, 0.9, 1.0])
PUSHES = st.tuples(
    st.sampled_from([PASS, ROUND]),
    st.lists(SHARES, min_size=2, max_size=2, unique=True).map(sorted),
    st.tuples(
        *[st.floats(-12, 12)] * 2, st.floats(-12, 4), st.floats(-1, 1), st.floats(-1.2, 0.8), st.floats(-2, 2)
    ),
    st.sampled_from([0.03, 0.3, 1.0]),
)


@pytest.mark.long
@pytest.mark.timeout(240)
@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(PUSHES, min_size=1, max_size=2))
def test_a_refined_path_that_is_taken_keeps_its_distances_keyframes_and_angles(pushes) -> None:
    ir = path()
    for shot, between, by, size in pushes:
        ir = bumped(ir, shot, size * np.array([*by, 0.0]), between)
    outcome = refine(returns(lambda _: ir))
    event("refused" if outcome.value is None else "taken")
    if outcome.value is None:
        assert {d.code for d in outcome.diagnostics} <= {"R006", "R007", "R008"}
        return
    timed = ParameterizeTime().run(outcome.value, PassContext())
    assert timed.value is not None
    found = {d.code for d in Verify().run(timed.value, PassContext()).diagnostics}
    assert not found & GEOMETRY
