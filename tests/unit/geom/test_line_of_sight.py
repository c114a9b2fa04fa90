"""Whether a solid stands between two points: the plain function against the one on arrays."""

from __future__ import annotations

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

from shotc.geom.line_of_sight import crosses
from shotc.geom.solids import Cylinder, Prism, box
from shotc.geom.solids_array import blocks

SOLIDS = (
    Cylinder((1.0, 0.5), 2.0, 0.0, 3.0),
    box((0.0, 1.0, 2.0), (3.0, 2.0, 4.0), 0.4),
    Prism(((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (3.0, 1.0)), 0.0, 3.0),
)
point = st.tuples(*[st.floats(-6, 6)] * 3)


@given(a=point, b=point, which=st.integers(0, 2))
def test_it_agrees_with_the_one_on_arrays(a, b, which) -> None:
    assume(np.linalg.norm(np.subtract(a, b)) > 0.1)
    solid = SOLIDS[which]
    grown = [
        crosses(solid, np.add(a, d).tolist(), np.add(b, d).tolist())
        for d in np.vstack([np.eye(3), -np.eye(3)]) * 1e-3
    ]
    assume(all(grown) or not any(grown))  # not at the very edge
    assert crosses(solid, a, b) == bool(blocks(solid, np.array([a]), np.array(b))[0])


def test_a_line_along_a_wall_is_met_where_the_wall_is_and_not_on_its_way_beyond() -> None:
    room = Prism(((0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0)), 0.0, 3.0)
    assert crosses(room, (-3.0, 0.0, 1.0), (1.0, 0.0, 1.0))
    assert not crosses(room, (-3.0, 0.0, 1.0), (-1.0, 0.0, 1.0))
    assert not crosses(room, (-3.0, 0.0, 1.0), (-3.0, 0.0, 2.0))  # upright, in the wall's line
