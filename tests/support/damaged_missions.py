"""Ways to damage a mission: hostile values in its tree, junk in its bytes."""

from __future__ import annotations

import copy
import math
from functools import cache
from pathlib import Path
from typing import Any

import yaml
from hypothesis import strategies as st

from tests.support.written_missions import SAFE_LOADER

ROOT = Path(__file__).parents[2]
MISSIONS = sorted([*ROOT.glob("specs/*.yaml"), *ROOT.glob("shotc/templates/*.yaml")])
SHOWS = sorted(Path(__file__).with_name("shows").glob("*.yaml"))
CHECKED = [*MISSIONS, *SHOWS, *SHOWS, *SHOWS]  # shows are few
TEXTS = [path.read_bytes() for path in CHECKED]

NUMBERS: list[Any] = [math.nan, math.inf, -math.inf, 1e300, -1e300, 1e-300, 0, -1, 0.5, 10**400, True, None]
QUANTITIES = [
    *(
        "8 s",
        "5 m/s",
        "70",
        "70 deg",
        "nan deg",
        "1e400 m",
        "-1 m",
        "1e9 min",
        "100 %",
        "-5 %",
        "12 furlongs",
    ),
    *("180 deg", "0 deg", "-70 deg", "179.999 deg", "1e-12 deg", "100000 deg"),
    *("16:0", "0:9", "16:9:4", "nan:1"),
]
WORDS = [
    *("", " ", "../../etc/passwd", "/etc/passwd", "..", ".", "a/b", "CON", "x" * 100_000, "é" * 300),
    *("a\x1b[31mb", "\u202egnp.exe", "\U0001f4a5", "a\u2028b"),
    *("tower", "nobody", "cam1", "left-third", "thirds", "auto", "keep", "center", "along"),
    *("framing", "display", "chase", "keyframes", "orbit", "follow-path"),
    *("swarm", "first", "*.obj", "walk/*", "*/*.ply", "star.svg", "pads.csv", "#ff0", "cylinder", "outline"),
]
LISTS: list[Any] = [
    *([], [[[[]]]], [1, 2], [1, 2, 3, 4], [5, 5], [math.nan, 0, 0], ["1 m", "2 s", None], ["10 m", "5 m"]),
    *([0, 0, -5], [0, 0, 12], [0, 0, 0], [1e9, 0, 10], [0, -60, 1e-9]),
]
MAPPINGS: list[Any] = [
    *(
        {},
        {"a": {"b": [1, {"c": None}]}},
        {"file": "../x.csv"},
        {"box": {"center": [0, 0, 0], "size": [0, -1, 2]}},
    ),
    *({"lat": 91, "lon": 500, "height": 3}, {"lat": 47.3769, "lon": 8.5417, "height": 30}),
    *(
        {"grid": {"spacing": 1e-4}},
        {"circle": {"radius": 1e-4}},
        {"sphere": {"center": [0, 0, 40], "radius": 1e5}},
    ),
    *({"start": -5}, {"start": 3}, {"duration": 1e-9}, {"duration": 1e12}, {"after": "reveal"}),
]
HOSTILE = [*NUMBERS, *QUANTITIES, *WORDS, *LISTS, *MAPPINGS]

Place = tuple[str | int, ...]


@cache
def trees() -> list[Any]:
    """Return the missions that are to be damaged, in the order of TEXTS."""
    return [yaml.load(text, SAFE_LOADER) for text in TEXTS]


def places(tree: Any, path: Place = ()) -> list[Place]:
    """Return the paths of all values below the top."""
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    return [p for key, value in items for p in ((*path, key), *places(value, (*path, key)))]


def at(tree: Any, path: Place) -> Any:
    for key in path:
        tree = tree[key]
    return tree


def replace(tree: Any, path: Place, value: Any) -> None:
    at(tree, path[:-1])[path[-1]] = value


def drop(tree: Any, path: Place, value: Any) -> None:
    del at(tree, path[:-1])[path[-1]]


def rename(tree: Any, path: Place, value: Any) -> None:
    """Misspell a key, or repeat a list item."""
    holder = at(tree, path[:-1])
    if isinstance(holder, dict):
        holder[f"{path[-1]}s"] = holder.pop(path[-1])
    else:
        holder.append(copy.deepcopy(holder[path[-1]]))


def add(tree: Any, path: Place, value: Any) -> None:
    """Put a value where there was none."""
    holder = at(tree, path[:-1])
    if isinstance(holder, dict):
        holder[value if isinstance(value, str) else "frame"] = value
    else:
        holder.insert(0, value)


def wrap(tree: Any, path: Place, value: Any) -> None:
    """Put a value one level deeper."""
    old = at(tree, path)
    replace(tree, path, [old] if isinstance(value, list) else {"at": old})


def borrow(tree: Any, path: Place, value: Any) -> None:
    """Put another part of the mission here; the value only says which."""
    others = places(tree)
    replace(tree, path, copy.deepcopy(at(tree, others[len(str(value)) * 7919 % len(others)])))


EDITS = (replace, replace, replace, replace, drop, rename, add, wrap, borrow)


@st.composite
def damaged_trees(draw: st.DrawFn) -> tuple[bytes, Path]:
    """A mission with one to three edits, and the folder of its files."""
    index = draw(st.integers(0, len(CHECKED) - 1))
    tree = copy.deepcopy(trees()[index])
    for _ in range(draw(st.integers(1, 3))):
        if found := places(tree):
            edit, place, value = (draw(st.sampled_from(x)) for x in (EDITS, found, HOSTILE))
            edit(tree, place, copy.deepcopy(value))
    return written(tree), CHECKED[index].parent


@st.composite
def bent_trees(draw: st.DrawFn) -> tuple[bytes, Path]:
    """A mission with one or two numbers scaled, which may still be one, and the folder of its files."""
    index = draw(st.integers(0, len(MISSIONS) - 1))
    tree = copy.deepcopy(trees()[index])
    numbers = [p for p in places(tree) if type(at(tree, p)) in (int, float) and p != ("shotc",)]
    for _ in range(draw(st.integers(1, 2))):
        place = draw(st.sampled_from(numbers))
        replace(tree, place, at(tree, place) * draw(st.sampled_from([0.5, 0.8, 0.95, 1.1, 1.5, -1])))
    return written(tree), MISSIONS[index].parent


def written(tree: Any) -> bytes:
    return yaml.safe_dump(tree, sort_keys=False, allow_unicode=True).encode()


JUNK = st.one_of(
    st.binary(min_size=1, max_size=4),
    st.sampled_from(
        b'\t \0 \xff [ ] { } " &a *a !!python/name:os : - \r | # % <<: ? \xef\xbb\xbf 1e999'.split(b" ")
    ),
    st.sampled_from([b"\n", b"\n---\n", b": ", b"\n- ", b"'", b"\xe2\x80\xa8", b" ", b"|\n", b"\n...\n"]),
)


@st.composite
def damaged_bytes(draw: st.DrawFn) -> tuple[bytes, Path]:
    """A mission with up to five insertions, cuts or doublings of its bytes, and the folder of its files."""
    index = draw(st.integers(0, len(TEXTS) - 1))
    data = TEXTS[index]
    for _ in range(draw(st.integers(1, 5))):
        start, length = draw(st.integers(0, len(data))), draw(st.integers(0, 40))
        ways = (
            data[:start] + draw(JUNK) + data[start:],
            data[:start] + data[start + length :],
            data[: start + length] + data[start:],
            data[:start],
        )
        data = ways[draw(st.sampled_from([0, 0, 0, 1, 1, 2, 3]))]
    return data, CHECKED[index].parent
