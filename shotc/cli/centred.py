"""Notes about shots whose composition has several places but keeps the target in the centre."""

from __future__ import annotations

from shotc.ir.keyframes import KeyframeIR, PlacedShot
from shotc.ir.mission import Composition

CENTRE = (0.0, 0.0)


def centred(ir: KeyframeIR) -> list[str]:
    """Return a line for each composition that has other places but keeps all targets of a shot in the centre.

    The line also names the composition that puts the target on a third.
    """
    shots: dict[str, list[str]] = {}
    for placed in ir.shots:
        name = _all_in_the_centre(placed)
        if name is not None:
            shots.setdefault(name, []).append(placed.shot.id)
    return [
        f"`{name}` keeps the target of {_listed(ids)} in the centre, the place of the set that is nearest to "
        "where the camera looks; `composition: thirds-first` puts it on a third"
        for name, ids in shots.items()
    ]


def _all_in_the_centre(placed: PlacedShot) -> str | None:
    """Return the composition of a shot if it has other places but all targets are centred, else None."""
    places = [
        *((k.composition, p.reference) for k, p in zip(placed.shot.keyframes, placed.keyframes, strict=True)),
        *((s.composition, p.reference) for s, p in zip(placed.shot.subjects, placed.subjects, strict=True)),
    ]
    framed = [(composition, place) for composition, place in places if place is not None]
    if not framed or any(place != CENTRE or not _has_others(kind) for kind, place in framed):
        return None
    return framed[0][0].name


def _has_others(composition: Composition) -> bool:
    return CENTRE in composition.points and len(composition.points) > 1


def _listed(ids: list[str]) -> str:
    names = ", ".join(f"`{name}`" for name in ids)
    return f"shot {names}" if len(ids) == 1 else f"shots {names}"
