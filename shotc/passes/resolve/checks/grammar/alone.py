"""Checks of a single shot with a known duration: its length, and the rate of its turns."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR, Shot
from shotc.passes.resolve.checks.grammar.labels import lasting
from shotc.passes.resolve.checks.grammar.leaving import check_leaving
from shotc.passes.resolve.checks.grammar.pans import check_pans

SHORTEST_S = 2.0  # seconds


def check_alone(mission: MissionIR, shot: Shot, judged: Callable[[str, Shot], bool]) -> Iterator[Diagnostic]:
    """Yield the faults of a shot with a known duration, independent of other shots."""
    if judged("short-shot", shot):
        yield from check_length(mission, shot)
    if judged("walks-out-of-frame", shot):
        yield from check_leaving(mission, shot)
    if judged("fast-pan", shot):
        yield from check_pans(mission, shot)


def check_length(mission: MissionIR, shot: Shot) -> Iterator[Diagnostic]:
    """Yield the warning of a shot that is too short to be read."""
    duration = shot.timing.duration
    if duration is None or duration >= SHORTEST_S:
        return
    yield Diagnostic(
        "F003",
        f"shot `{shot.id}` is over before it is seen",
        (lasting(mission, shot),),
        (f"it lasts {duration:.1f} s; a picture that moves takes about {SHORTEST_S:.1f} s to be read",),
        f"give it {SHORTEST_S:.0f} s or more, or write `allow: [short-shot]` in it",
    )
