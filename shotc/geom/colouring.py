"""Graph colouring of places: two places of one colour are at least a distance apart. Plain Python.

Two places conflict if they are nearer than the distance. For a square grid, a sublattice of index N whose
shortest vector is long enough gives a colouring with N colours. Other layouts, and grids where it needs fewer
colours, use greedy colouring in smallest-last order (Matula and Beck, Smallest-last ordering, 1983).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from math import dist, floor, hypot, inf, sqrt

from shotc.geom.vec import Vec2

ROUNDING_M = 1e-6
"""Tolerance of the distance, metres."""


def coloured(places: Sequence[Vec2], least: float) -> tuple[int, ...]:
    """Return a colour for every place, from 0; two of one colour are at least ``least`` metres apart."""
    around = conflicts(places, least)
    colours = _smallest_last(around)
    fewest = max(colours, default=0) + 1
    regular = _on_lattice(places, least, fewest)
    chosen = colours if regular is None else regular
    names = {colour: k for k, colour in enumerate(sorted(set(chosen)))}
    return tuple(names[colour] for colour in chosen)


def fewest_colours(places: Sequence[Vec2], least: float) -> int:
    """Return a lower bound on the number of colours: the most places in a square that is a clique."""
    side = (least - ROUNDING_M) / sqrt(2.0) * (1.0 - 1e-9)
    cells: dict[tuple[int, int], int] = defaultdict(int)
    for x, y in places:
        cells[floor(x / side), floor(y / side)] += 1
    return max(cells.values(), default=0)


def conflicts(places: Sequence[Vec2], least: float) -> list[list[int]]:
    """Return for every place the indices of the others that are nearer to it than ``least`` metres."""
    cells: dict[tuple[int, int], list[int]] = defaultdict(list)
    for i, (x, y) in enumerate(places):
        cells[floor(x / least), floor(y / least)].append(i)
    reach = least - ROUNDING_M
    return [
        [j for j in _near(cells, place, least) if j != i and dist(place, places[j]) < reach]
        for i, place in enumerate(places)
    ]


def _near(cells: dict[tuple[int, int], list[int]], place: Vec2, width: float) -> Iterator[int]:
    a, b = floor(place[0] / width), floor(place[1] / width)
    for i in (a - 1, a, a + 1):
        for j in (b - 1, b, b + 1):
            yield from cells.get((i, j), ())


def _smallest_last(around: Sequence[Sequence[int]]) -> list[int]:
    """Return the greedy colouring in smallest-last order."""
    left = [len(near) for near in around]
    buckets: dict[int, list[int]] = defaultdict(list)
    for i, count in enumerate(left):
        buckets[count].append(i)
    taken = [False] * len(around)
    order: list[int] = []
    fewest = 0
    while len(order) < len(around):
        while not buckets[fewest]:
            fewest += 1
        i = buckets[fewest].pop()
        if taken[i] or left[i] != fewest:
            continue
        taken[i] = True
        order.append(i)
        for j in around[i]:
            if not taken[j]:
                left[j] -= 1
                buckets[left[j]].append(j)
        fewest = max(0, fewest - 1)
    colours = [-1] * len(around)
    for i in reversed(order):
        used = {colours[j] for j in around[i]}
        colours[i] = next(c for c in range(len(used) + 1) if c not in used)
    return colours


def _on_lattice(places: Sequence[Vec2], least: float, fewest: int) -> list[int] | None:
    """Return the colouring by the best sublattice; None for other layouts or above ``fewest`` colours."""
    index = _grid(places)
    if index is None:
        return None
    (spacing, steps) = index
    for count in range(2, fewest + 1):  # with one colour there is nothing to choose
        for a in (a for a in range(1, count + 1) if count % a == 0):
            d = count // a
            for b in range(a):
                if spacing * _shortest(a, b, d) >= least - ROUNDING_M:
                    return [j % d * a + (i - j // d * b) % a for i, j in steps]
    return None


def _shortest(a: int, b: int, d: int) -> float:
    """Return the length of the shortest vector of the lattice with basis (a, 0) and (b, d)."""
    best = float(a)
    rows = 1
    while rows * d < best:
        across = rows * b % a
        best = min(best, hypot(min(across, a - across), rows * d))
        rows += 1
    return best


def _grid(places: Sequence[Vec2]) -> tuple[float, list[tuple[int, int]]] | None:
    """Return the spacing of a square grid and the steps from the first place; None for other layouts."""
    (x0, y0) = places[0]
    spacing = min((dist(places[0], place) for place in places[1:]), default=inf)
    if not 0.0 < spacing < inf:
        return None
    x1, y1 = min(places[1:], key=lambda place: dist(places[0], place))
    ux, uy = (x1 - x0) / spacing, (y1 - y0) / spacing
    steps: list[tuple[int, int]] = []
    for x, y in places:
        along, across = (x - x0) * ux + (y - y0) * uy, (y - y0) * ux - (x - x0) * uy
        i, j = round(along / spacing), round(across / spacing)
        if hypot(along - i * spacing, across - j * spacing) > ROUNDING_M:
            return None
        steps.append((i, j))
    return (spacing, steps) if len(set(steps)) == len(steps) else None
