"""The compositions of a shot in words."""

from __future__ import annotations

from typing import NamedTuple

from shotc.ir.keyframes import PlacedShot, PlacedSubject
from shotc.ir.limits import Vec2
from shotc.ir.mission import Composition
from shotc.spec.compositions import NAMED_POINTS

SAME_PLACE_HALF_FRAMES = 1e-6


def composition_text(placed: PlacedShot) -> str:
    """Return a shot's compositions and the places used of each, by subject where subjects differ.

    Examples are "thirds (center)" and "one left-third; other right-third"; it is "" if nothing is framed.
    """
    words: dict[str, dict[str, list[str]]] = {}
    for used in _references(placed):
        flown = words.setdefault(used.target, {}).setdefault(used.composition.name, [])
        place = _place(used.composition, used.place)
        if place and place not in flown:
            flown.append(place)
    said = {target: ", ".join(_phrase(*item) for item in sets.items()) for target, sets in words.items()}
    if len(set(said.values())) <= 1:
        return next(iter(said.values()), "")
    return "; ".join(f"{target} {text}" for target, text in said.items())


class _Reference(NamedTuple):
    """A composition of a target, and the place of it that is used; None if it has no place."""

    target: str
    composition: Composition
    place: Vec2 | None


def _references(placed: PlacedShot) -> list[_Reference]:
    # Only what the composition pass chose counts: between keyframes a reference also passes other places.
    shot = placed.shot
    if not placed.keyframes:
        return [
            _Reference(subject.target, composition, place)
            for subject, written in zip(placed.subjects, shot.subjects, strict=True)
            for composition, place in _in_turn(written.composition, subject)
        ]
    return [
        _Reference(keyframe.target, written.composition, keyframe.reference)
        for keyframe, written in zip(placed.keyframes, shot.keyframes, strict=True)
        if keyframe.target is not None
    ]


def _in_turn(composition: Composition, subject: PlacedSubject) -> list[tuple[Composition, Vec2 | None]]:
    """Return a subject's composition and place, then the places of its setpoints."""
    first = (composition, subject.reference)
    later = [setpoint.place for setpoint in subject.setpoints if setpoint.place is not None]
    return [first, *((Composition(_name_of(place), (place,)), place) for place in later)]


def _phrase(name: str, flown: list[str]) -> str:
    return f"{name} ({', '.join(flown)})" if flown else name


def _place(composition: Composition, reference: Vec2 | None) -> str:
    """Return the name of the point that is used, as a mission would write it; "" if there is no choice."""
    if reference is None or len(composition.points) < 2:
        return ""
    if not any(_same(point, reference) for point in composition.points):
        return "elsewhere"
    return _name_of(reference)


def _name_of(place: Vec2) -> str:
    """Return a place on screen as a mission would write it."""
    named = (name for name, point in NAMED_POINTS.items() if _same(point, place))
    return next(named, "[{:.3g}, {:.3g}]".format(*place))


def _same(a: Vec2, b: Vec2) -> bool:
    return max(abs(a[0] - b[0]), abs(a[1] - b[1])) < SAME_PLACE_HALF_FRAMES
