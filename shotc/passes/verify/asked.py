"""Differences between a plan's data of its mission and the mission itself, lowered again."""

from collections.abc import Iterator, Sequence
from itertools import zip_longest
from math import isfinite
from typing import Any, NamedTuple

from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import ELSEWHERE_IN_PLANS, MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.text import field_names
from shotc.units import clip

SAME_SHARE = 1e-9
"""Relative tolerance of a number (at least of one), because machines round sines differently."""

ITERATED_SHARE = 1e-6
"""The same for places found by iteration, from the framing of subjects."""

WRITTEN = {"promise": "require"}
"""Fields with another name in the mission file."""

ELSEWHERE = frozenset({"path", "source_sha256"})
"""Fields that contain places in a file, which may differ in another file."""


class MissionDifference(NamedTuple):
    """One difference between a plan and its mission; path : key path in the mission."""

    path: KeyPath
    text: str


class _ComparedPlace(NamedTuple):
    """The place of a comparison, in words and as a key path.

    passed : fields that are skipped
    near : relative tolerance of a number
    """

    words: str
    path: KeyPath
    passed: frozenset[str]
    near: float = SAME_SHARE

    def field(self, name: str) -> "_ComparedPlace":
        """Return the place of a field."""
        words = f"{self.words}, {name}" if self.words else name
        return self._replace(words=words, path=(*self.path, WRITTEN.get(name, name)))

    def item(self, words: str, path: KeyPath) -> "_ComparedPlace":
        """Return the place of an element with its own name."""
        return self._replace(words=words, path=path)

    def differs(self, text: str) -> MissionDifference:
        """Return a difference here."""
        return MissionDifference(self.path, f"{self.words}{text}")


def differences(
    written: KeyframeIR, reviewed: KeyframeIR, *, same_text: bool = True
) -> Iterator[MissionDifference]:
    """Yield the differences between a plan's data and what the mission asks for.

    same_text : whether both were lowered from one text, so that all places in it must be equal
    """
    passed = ELSEWHERE_IN_PLANS if same_text else ELSEWHERE_IN_PLANS | ELSEWHERE
    yield from _walk(written.mission, reviewed.mission, _ComparedPlace("", (), passed))
    yield from _walk(
        written.shots, reviewed.shots, _ComparedPlace("placed shots", ("shots",), passed | {"shot"})
    )
    if same_text:
        yield from _origins(written, reviewed)


def source_differences(written: MissionIR, reviewed: MissionIR) -> Iterator[MissionDifference]:
    """Yield where a plan's files or choices are not those that its mission uses."""
    for words, mine, true in (
        (
            "the tables in the plan",
            [n for n, _ in written.source.tables],
            [n for n, _ in reviewed.source.tables],
        ),
        ("the files that the plan links to", written.source.linked, reviewed.source.linked),
        ("the drawings in the plan", written.source.drawn, reviewed.source.drawn),
        ("the drones that were chosen", written.source.chosen, reviewed.source.chosen),
    ):
        if mine != true:
            yield MissionDifference((), f"{words} are not those that the mission uses")


def _origins(written: KeyframeIR, reviewed: KeyframeIR) -> Iterator[MissionDifference]:
    """Yield the first wrong place in the file."""
    one, other = written.mission.origins, reviewed.mission.origins
    for mine, true in ((one.keys, other.keys), (one.values, other.values)):
        for path, span in mine.items():
            if path not in true or true[path] != span:
                name = ".".join(map(str, path)) or "the mission"
                yield MissionDifference(path, f"the place of {name} in the file is another one")
                return


def _walk(written: Any, reviewed: Any, at: _ComparedPlace) -> Iterator[MissionDifference]:
    if written is reviewed:
        return
    if isinstance(written, float | int) and isinstance(reviewed, float | int):
        if not _same(written, reviewed, at.near):
            yield at.differs(f" is {_as_text(written)} in the plan, but {_as_text(reviewed)} in the mission")
    elif type(written) is not type(reviewed):
        yield at.differs(f" is {_as_text(written)} in the plan, but {_as_text(reviewed)} in the mission")
    elif names := field_names(reviewed):
        near = ITERATED_SHARE if getattr(reviewed, "framed", False) is True else at.near
        here = at._replace(path=getattr(reviewed, "path", at.path), near=near)
        for name in names:
            if name not in at.passed:
                yield from _walk(getattr(written, name), getattr(reviewed, name), here.field(name))
    elif isinstance(reviewed, tuple):
        yield from _items(written, reviewed, at)
    elif written != reviewed:
        yield at.differs(f" is {_as_text(written)} in the plan, but {_as_text(reviewed)} in the mission")


def _items(
    written: Sequence[Any], reviewed: Sequence[Any], at: _ComparedPlace
) -> Iterator[MissionDifference]:
    named = [_name(item) for item in (*written, *reviewed)]
    if named and all(named):
        yield from _named(written, reviewed, at)
    elif all(isinstance(item, float | int | str) for item in (*written, *reviewed)):
        pairs = zip(written, reviewed, strict=False)
        if len(written) != len(reviewed) or not all(_same(one, other, at.near) for one, other in pairs):
            yield at.differs(f" is {_as_text(written)} in the plan, but {_as_text(reviewed)} in the mission")
    elif len(written) != len(reviewed):
        yield at.differs(f": the plan has {len(written)}, the mission asks for {len(reviewed)}")
    else:
        for i, (one, other) in enumerate(zip(written, reviewed, strict=True), 1):
            words = f"{_one_of(at.words)} {i}"
            yield from _walk(one, other, at.item(words, _path(other, at)))


def _named(
    written: Sequence[Any], reviewed: Sequence[Any], at: _ComparedPlace
) -> Iterator[MissionDifference]:
    """Yield differences of elements with names: which exist, their order, and each with its namesake."""
    mine, true = {_name(item): item for item in written}, {_name(item): item for item in reviewed}
    for name, item in true.items():
        if name not in mine:
            yield MissionDifference(_path(item, at), f"{at.words}: `{name}` is left out")
    for name in mine:
        if name not in true:
            yield at.differs(f": the mission has no `{clip(name)}`")
    if mine.keys() == true.keys():
        for one, other in zip_longest(written, reviewed):
            if one is None or other is None or _name(one) != _name(other):
                yield at.differs(" are in another order, or there twice")
                break
    for name, item in true.items():
        if name in mine:
            place = at.item(f"{_one_of(at.words)} `{name}`", _path(item, at))
            yield from _walk(mine[name], item, place)


def _path(item: Any, at: _ComparedPlace) -> KeyPath:
    """Return the key path of an element; for a placed shot that of its shot."""
    path: KeyPath = getattr(getattr(item, "shot", item), "path", at.path)
    return path


def _one_of(words: str) -> str:
    """Return the singular of a plural name."""
    return words.removesuffix("s")


def _name(item: Any) -> str:
    """Return the name of an element; empty where it has none."""
    if not field_names(item):
        return ""
    if "shot" in field_names(item):
        return _name(item.shot)
    name = getattr(item, "name", getattr(item, "id", ""))
    return name if isinstance(name, str) else ""


def _same(a: Any, b: Any, near: float) -> bool:
    if isinstance(a, float) and isinstance(b, float) and isfinite(a) and isfinite(b):
        return abs(a - b) <= near * max(1.0, abs(a), abs(b))
    return bool(a == b) and isinstance(a, bool) == isinstance(b, bool)


def _as_text(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return f"{value:.9g}"
    if isinstance(value, int):
        return clip(str(value))
    if isinstance(value, tuple) and not field_names(value):
        return clip(f"({', '.join(map(_as_text, value))})")
    if field_names(value):
        return f"a {type(value).__name__}"
    return "nothing" if value is None else f"`{clip(str(value))}`"
