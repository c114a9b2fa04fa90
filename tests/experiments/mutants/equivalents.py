"""Mutants that no test can kill, each with the reason: they do what the source does, or it does not matter.

A mutant is known by its file, the text of its line and its change, so that lines may move.
"""

from __future__ import annotations

from typing import NamedTuple

from tests.experiments.mutants.changes import Mutant


class Equivalent(NamedTuple):
    """A mutant that is no fault.

    source : the text of its line; change : as the report writes it; nth : of the same ones in its file, from 0;
        None for all of them
    """

    path: str
    source: str
    change: str
    reason: str
    nth: int | None = None

    @property
    def key(self) -> tuple[str, str, str]:
        """What the mutant is known by."""
        return self.path, self.source, self.change


def is_equivalent(mutant: Mutant) -> bool:
    """Whether a mutant is one of those that are no fault."""
    return any(e.key == mutant.key and e.nth in {None, mutant.nth} for e in EQUIVALENTS)


EQUIVALENTS: tuple[Equivalent, ...] = (
    Equivalent(
        "shotc/geom/separation.py",
        "for low, high in slabs[:: max(1, len(slabs) // SAMPLE_SLABS)]:",
        "1  ->  2",
        "slabs are sampled for a first upper bound alone; branch and bound ends within the same gap",
    ),
    Equivalent(
        "shotc/geom/surface/tree.py",
        "TOP_NODES = 16",
        "16  ->  17",
        "how many boxes a search begins with: all of them are held against what is sought, whatever their number",
    ),
    Equivalent(
        "shotc/geom/surface/inside.py",
        "for axis in (0, 1):",
        "1  ->  2",
        "boxes that a ray misses are only left out early; `pierced` tells which of the rest it crosses",
    ),
    Equivalent(
        "shotc/geom/surface/inside.py",
        "for axis in (0, 1):",
        "0  ->  1",
        "boxes that a ray misses are only left out early; `pierced` tells which of the rest it crosses",
    ),
    Equivalent(
        "shotc/geom/outline.py",
        'square = np.maximum(np.einsum("md,md->m", along, along), NO_LENGTH_M**2)',
        "2  ->  3",
        "it keeps a division from zero where the eye is in the outline, and any tiny number does",
    ),
    Equivalent(
        "shotc/geom/terrain/systems.py",
        "_DELTA = _series((2, -2 / 3, -2, 116 / 45), (7 / 3, -8 / 5, -227 / 45), (56 / 15, -136 / 35), (4279 / 630,))",
        "136  ->  137",
        "n^4 / 35 is 2.3e-13 rad, 1.5 micrometres on the ground; the series is told to be good to a few of them",
    ),
    Equivalent(
        "shotc/solvers/retiming_socp.py",
        "unit = 1.0 / np.maximum(self.b_unit[:-1], self.b_unit[1:])",
        "1.0  ->  2.0",
        "it multiplies all terms of equations whose other side is zero",
    ),
    Equivalent(
        "shotc/geom/turning.py",
        "return np.concatenate([t[(s > 0) & (s < 1)] for t, s in zip(at, shares, strict=True)])",
        "1  ->  2",
        "a time too many only cuts a stretch in two, on which the course changes one way: what both turn sums to it",
    ),
    Equivalent(
        "shotc/passes/verify/meeting.py",
        "at = [track.curve(min(claim.time, track.curve.end))[:3] for track in pair]",
        "3  ->  4",
        "x, y and z alone are written",
    ),
    Equivalent(
        "shotc/geom/terrain/relief.py",
        "_SIDE_SAMPLES = 33  # samples on each side of a box that are transformed to the system of the file",
        "33  ->  34",
        "sides bulge by far less than the posts to spare, so that one sample more takes the same posts",
    ),
    Equivalent(
        "shotc/geom/solid_arrays/rings.py",
        "POLYGON_SIDES = 48",
        "48  ->  49",
        "the polygon is around its circle whatever its number of sides",
    ),
    Equivalent(
        "shotc/show/geom/arcs.py",
        "WAY_POINTS = 1500",
        "1500  ->  1501",
        "points of a way are off its arc by a ten-millionth of the radius either way, which pushed_out makes good",
    ),
    Equivalent(
        "shotc/geom/solid_arrays/segments.py",
        "upright = a < 1e-18",
        "1e-18  ->  1e-15",
        "a line that goes 3e-8 m aside over its length is upright to a thirtieth of what counts as inside",
    ),
    Equivalent(
        "shotc/geom/solid_arrays/segments.py",
        "first = np.where(upright, np.where(c <= 0, 0.0, 1.0), (-b - root) / safe)",
        "0  ->  1",
        "an upright line outside the circle leaves at 0 by the next line, and is outside wherever it enters",
    ),
    Equivalent(
        "shotc/show/geom/layers.py",
        "4: ((0.5, 0.5), (0.5, 0.0), (0.0, 0.5)),",
        "0.5  ->  1.5",
        "a shift by a whole step is the same lattice, and what is laid begins a step beyond the shape",
    ),
    Equivalent(
        "shotc/show/geom/layers.py",
        "4: ((0.5, 0.5), (0.5, 0.0), (0.0, 0.5)),",
        "0.0  ->  1.0",
        "a shift by a whole step is the same lattice, and what is laid begins a step beyond the shape",
    ),
    Equivalent(
        "shotc/show/geom/layers.py",
        "3: ((0.5, sqrt(3.0) / 6.0), (0.0, sqrt(3.0) / 3.0)),",
        "0.5  ->  1.5",
        "a shift by a whole step is the same lattice, and what is laid begins a step beyond the shape",
    ),
    Equivalent(
        "shotc/show/geom/layers.py",
        "3: ((0.5, sqrt(3.0) / 6.0), (0.0, sqrt(3.0) / 3.0)),",
        "0.0  ->  1.0",
        "a shift by a whole step is the same lattice, and what is laid begins a step beyond the shape",
    ),
    Equivalent(
        "shotc/show/geom/layers.py",
        "4: ((0.5, 0.0), (0.25, sqrt(3.0) / 4.0), (0.75, sqrt(3.0) / 4.0)),",
        "0.5  ->  1.5",
        "a shift by a whole step is the same lattice, and what is laid begins a step beyond the shape",
    ),
    Equivalent(
        "shotc/show/geom/layers.py",
        "4: ((0.5, 0.0), (0.25, sqrt(3.0) / 4.0), (0.75, sqrt(3.0) / 4.0)),",
        "0.25  ->  1.25",
        "a shift by a whole step is the same lattice, and what is laid begins a step beyond the shape",
    ),
    Equivalent(
        "shotc/show/geom/layers.py",
        "4: ((0.5, 0.0), (0.25, sqrt(3.0) / 4.0), (0.75, sqrt(3.0) / 4.0)),",
        "0.75  ->  1.75",
        "a shift by a whole step is the same lattice, and what is laid begins a step beyond the shape",
    ),
    Equivalent(
        "shotc/show/geom/layers.py",
        "low = rows_of(np.full(2, -2.0), np.full(2, 4.0), 1.0, square)",
        "4.0  ->  5.0",
        "a wider window holds the same nearest neighbours of a place in its middle",
    ),
    Equivalent(
        "shotc/show/geom/layers.py",
        "low = rows_of(np.full(2, -2.0), np.full(2, 4.0), 1.0, square)",
        "2.0  ->  3.0",
        "a wider window holds the same nearest neighbours of a place in its middle",
    ),
    Equivalent(
        "shotc/passes/verify/fleets/apart.py",
        "if len(flight.names) > 1 and take_off_of(flight.fleet).layered:",
        ">  ->  >=",
        "a fleet of one drone has one layer",
    ),
    Equivalent(
        "shotc/geom/surface/sight.py",
        "far = dot(normal, corners[:, 0])",
        "0  ->  1",
        "every corner of a triangle is in its plane",
    ),
    Equivalent(
        "shotc/geom/surface/sight.py",
        'nearest = (np.einsum("kd,ked->ek", normal, self.ends[frame]) * np.sign(far)).max(axis=0)',
        "*  ->  /",
        "a sign is its own inverse",
    ),
    Equivalent(
        "shotc/geom/terrain/relief.py",
        "places = of_world(np.column_stack([x, y, np.zeros(len(x))]), origin)",
        "zeros  ->  ones",
        "a metre of height moves a place by less than a millimetre, and two posts beyond are taken",
    ),
    Equivalent(
        "shotc/geom/proof.py",
        "best, at, closed = -np.inf, 0.0, -np.inf",
        "0.0  ->  1.0",
        "the place of a supremum over no pieces, which is -inf; with any piece it is overwritten",
    ),
    Equivalent(
        "shotc/geom/colouring.py",
        "side = (least - ROUNDING_M) / sqrt(2.0) * (1.0 - 1e-9)",
        "1e-9  ->  1.0000000000000002e-06",
        "places in a smaller square are a clique, too: the bound holds, and layouts have no such fine grain",
    ),
    Equivalent(
        "shotc/geom/surface/height.py",
        "turn = np.where(whole, turn, 1.0)",
        "1.0  ->  2.0",
        "it keeps a division from zero, and the last line does not use what is not whole",
    ),
    Equivalent(
        "shotc/geom/surface/near.py",
        "ROUNDING = 1e-9",
        "1e-9  ->  1.0000000000000002e-06",
        "a wider tolerance leaves more boxes to look at; the distances of their triangles decide",
    ),
    Equivalent(
        "shotc/geom/surface/sight.py",
        "ends = RAY_SHARE * np.minimum(reach, 1.0).reshape(-1, reach.shape[1] * reach.shape[2])",
        "1  ->  2",
        "cells are n x n; and numpy takes any negative size for the one that is left",
    ),
    Equivalent(
        "shotc/geom/surface/sight.py",
        "return np.asarray(hidden(surface, billboards(eyes, points, 0.0, 0.0), 1)[:, 0, 0])",
        "0.0  ->  1.0",
        "the middle of a rectangle of any size is the point",
    ),
    Equivalent(
        "shotc/geom/surface/tree.py",
        "limit = max(LONG_EDGE_RATIO * float(np.median(edges)), LONG_EDGE_RATIO * 1e-3 * float(edges.max()), 1e-9)",
        "1e-9  ->  1.0000000000000002e-06",
        "it keeps a division from zero where all triangles are points",
    ),
    Equivalent(
        "shotc/geom/terrain/systems.py",
        "(1 / 2, -2 / 3, 37 / 96, -1 / 360), (1 / 48, 1 / 15, -437 / 1440), (17 / 480, -37 / 840), (4397 / 161280,)",
        "161280  ->  161281",
        "n^4 / 161280^2 of the earth's radius is less than a picometre",
    ),
    Equivalent(
        "shotc/solvers/topp_lp.py",
        "rows.positive(0.0 * one, [(inside, one)])",
        "rows.positive(0.0 * one, [(inside, one)])  ->  pass",
        "b is maximised and standing still is allowed, so that 0 is no bound that a profile comes to",
    ),
    Equivalent(
        "shotc/geom/integral.py",
        "break",
        "break  ->  continue",
        "without pieces the rounds that are left add nothing",
    ),
    Equivalent(
        "shotc/show/geom/layers.py",
        "each = [rows_of(low - step, high + step, step, layers.square) + step * np.array(s) for s in layers.shifts]",
        "+  ->  -",
        "the same layers, mirrored at a place; what is laid begins a step beyond the shape",
        1,
    ),
    Equivalent(
        "shotc/show/geom/layers.py",
        "shifts = ((0.0, 0.0), *(_SQUARE if square else _HEXAGON)[count])",
        "0.0  ->  1.0",
        "a shift by a whole step along the rows is the same lattice",
        0,
    ),
    Equivalent(
        "shotc/passes/verify/promises.py",
        "if (finish - start) * (last - first) <= 0:",
        "*  ->  /",
        "a quotient has the sign of the product, and the language refuses equal ends",
    ),
    Equivalent(
        "shotc/show/solvers/arc_move.py",
        "needs = np.hypot(speeds, np.sqrt(busy.shares(bend[:, :2], 2, bend[:, 2]) / ASKED_SHARE))",
        "2  ->  3",
        "a column more than there are parts is not used",
        0,
    ),
    Equivalent(
        "shotc/passes/verify/sight.py",
        "return max(0.0, sup_convex(bend, norm, lambda best: max(1e-3, 0.05 * abs(best))).proven)",
        "0.05  ->  1.05",
        "a coarser bound of a rate is above it as well; the search halves until its own gap is closed",
    ),
    Equivalent(
        "shotc/passes/verify/fleets/burning.py",
        "bound = outside_of_mesh(burning, (float(burning.low[0]), burning.ctrl[:, 0, 0]), mesh, least)",
        "0  ->  1",
        "who is inside at one of the two places and outside at the other passes the surface: it is too near either way",
        1,
    ),
    Equivalent(
        "shotc/show/solvers/own_heights.py",
        "TOLERANCE = 1e-7",
        "1e-7  ->  9.999999999999999e-05",
        "a round begins from what the one before gave, however rough; what is taken is looked at, and proved by callers",
    ),
    Equivalent(
        "shotc/show/solvers/wave_move.py",
        "LEAST_PIECES = 12",
        "12  ->  13",
        "a spline of one piece more flies the same wave; no number of pieces is promised",
    ),
    Equivalent(
        "shotc/geom/proof.py",
        "break",
        "break  ->  continue",
        "without halving the rounds that are left find the same bound",
        3,
    ),
    Equivalent(
        "shotc/solvers/headings/virtual.py",
        "NEAREST, FARTHEST = 0.5, 4.0  # radii of inner keyframes",
        "4.0  ->  5.0",
        "a range in which a radius is searched for; the heading does not depend on the scale, and is checked",
    ),
    Equivalent(
        "shotc/solvers/cone_rows.py",
        "settings.max_threads = 1",
        "1  ->  2",
        "threads share the work of a factorisation; how many may do so changes no result",
    ),
    Equivalent(
        "shotc/show/solvers/own_heights.py",
        "none = np.zeros(len(x[0][0]))",
        "0  ->  1",
        "all columns and weights of a derivative have as many rows",
    ),
    Equivalent(
        "shotc/geom/surface/sight.py",
        "if disc > 0.0 and without_size(corners).all():",
        "0.0  ->  1.0",
        "points have no plane: the test by planes, which this condition saves, keeps them all as well",
    ),
    Equivalent(
        "shotc/geom/surface/sight.py",
        "normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])",
        "0  ->  1",
        "the product of any two sides is the same normal",
        1,
    ),
    Equivalent(
        "shotc/geom/solid_arrays/rings.py",
        "return np.asarray(radius / np.cos(np.pi / sides) * np.stack([np.cos(turn), np.sin(turn)], axis=-1))",
        "-  ->  nothing",
        "angles have one axis, so that the last one is the second",
    ),
    Equivalent(
        "shotc/show/solvers/own_heights.py",
        "constant, terms = self._power(most, order, len(axes[0][0][0]))",
        "0  ->  1",
        "all columns and weights of a derivative have as many rows",
    ),
    Equivalent(
        "shotc/passes/verify/sight.py",
        "least = float(sight.out(times[:1])[0])",
        "1  ->  2",
        "the first of two values is that of the first time",
    ),
    Equivalent(
        "shotc/passes/verify/sight.py",
        "MOST_HALVINGS = 40",
        "40  ->  41",
        "after 40 halvings an interval is shorter than a time can be told",
    ),
    Equivalent(
        "shotc/show/geom/columns.py",
        "size = np.maximum(high - low, 1e-9 * max(1.0, float((high - low).max())))",
        "-  ->  +",
        "it keeps a division from zero, and any tiny number does",
        1,
    ),
)
