"""Missions with one runner and one statue, and what film grammar says of them."""

from __future__ import annotations

from collections.abc import Sequence

from shotc.diag.model import Diagnostic
from tests.support.front_passes import resolved

HEAD = """\
shotc: 1
mission: grammar
targets:
  runner: {{track: {{points: {points}, times: {times}}}, radius: 0.4, height: 1.8}}
  statue: {{at: {statue}, radius: 1, height: 4}}
drones:
  cam1: {{model: x500, home: {home}, camera: {{hfov: 70 deg, aspect: "16:9"}}, limits: {{speed: 12}}}}
  cam2: {{model: x500, home: {home2}, camera: {{hfov: 70 deg, aspect: "16:9"}}, limits: {{speed: 12}}}}
rules: {{composition: center, allow: [{allow}]}}
shots:
"""


def mission(
    *shots: str,
    points: Sequence[Sequence[float]] = ((0, 0, 0.9), (90, 0, 0.9)),
    times: Sequence[float] = (0, 60),
    shift: tuple[float, float] = (0.0, 0.0),
    mirror: bool = False,
    allow: str = "",
) -> str:
    """Return a mission; `[x, y, z]` of the shots are theirs to place, the rest is put here.

    shift : moves all; mirror : turns East to West
    """

    def put(p: Sequence[float]) -> list[float]:
        return [(-p[0] if mirror else p[0]) + shift[0], p[1] + shift[1], p[2]]

    head = HEAD.format(
        points=[put(p) for p in points],
        times=list(times),
        statue=put((0, 40, 2)),
        home=put((45, -60, 0)),
        home2=put((45, 90, 0)),
        allow=allow,
    )
    drone = "" if any("drone:" in shot for shot in shots) else "drone: cam1, "
    return head + "".join(f"  - {{{drone}{shot}}}\n" for shot in shots)


def grammar(text: str) -> list[Diagnostic]:
    """Return the warnings of film grammar; fail where anything else is said."""
    found = resolved(text)[1]
    assert all(d.code.startswith("F") for d in found), found
    return found


def codes(*shots: str, **how: object) -> list[str]:
    return [d.code for d in grammar(mission(*shots, **how))]  # type: ignore[arg-type]


def at(d: Diagnostic) -> tuple[int, int]:
    return (d.labels[0].span.line, d.labels[0].span.column)
