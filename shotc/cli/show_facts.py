"""Facts about a show in the summary of a plan: its displays, how its fleets move, and dense pictures.

``stats`` are the statistics of the passes: (name, value) pairs.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from shotc.ir.fleet import FleetTrajectory
from shotc.ir.phases import Phase
from shotc.ir.trajectory import VerifiedIR
from shotc.rounding import as_minutes, at_least

LAYERS = ("layers", "layers deep m", "layers seen m", "layers aside m")
TAKE_OFF = ("layers", "lowest m", "highest m", "s", "landing s")


def recorded(stats: Iterable[tuple[str, float | str]]) -> Iterator[str]:
    """Yield for each recorded flight the part that is flown, the distance from its file, and the clock."""
    known = dict(stats)
    for name in known:
        flight = re.fullmatch(r"flight (.+) off m", name)
        if flight:
            start, end, longer, off = (
                float(known[f"flight {flight[1]} {key}"]) for key in ("from s", "to s", "longer s", "off m")
            )
            clock = f"{longer:.2f} s longer" if longer > 0.0 else "at its own times"
            fleet = f"fleet {known[f'flight {flight[1]} fleet']}"
            corrected, moved = (float(known[f"{fleet} {key} shift"]) for key in ("bound", "apart"))
            apart = f"; {known[f'{fleet} apart moved']:.0f} are moved so that all stay apart" if moved else ""
            yield (
                f"{flight[1]} flies its file from {start:.2f} s to {end:.2f} s, {clock}, "
                f"within {at_least(off + corrected + moved, 3)} m of every track{apart}"
            )


def layered(stats: Iterable[tuple[str, float | str]]) -> Iterator[str]:
    """Yield the depth of pictures in layers, and how it looks from a seat beside the axis."""
    known = dict(stats)
    for name in known:
        picture = re.fullmatch(r"goals (.+)/(\d+) layers", name)
        if picture:
            at = name.removesuffix("layers")
            count, deep, seen, off = (float(known[at + key]) for key in LAYERS)
            where = f"picture {picture[2]} of {picture[1]}"
            yield (
                f"{where} is {deep:.2f} m deep, in {count:.0f} layers: its lights may look {seen:.2f} m "
                f"apart, and from 20 m beside the axis the last layer looks {off:.2f} m aside"
            )


def taking_off(stats: Iterable[tuple[str, float | str]]) -> Iterator[str]:
    """Yield the fleets that rise and land in layers or return to their own pads, with the heights."""
    known = dict(stats)
    for name in known:
        own = re.fullmatch(r"fleet (.+) own pads levels", name)
        if own:
            count, high = (float(known[name.removesuffix("levels") + key]) for key in ("levels", "highest m"))
            levels = "one level" if count == 1 else f"{count:.0f} levels"
            above = f"up to {at_least(high, 1)} m above them"
            yield f"drones of {own[1]} return to their own pads on {levels}, {above}"
        fleet = re.fullmatch(r"fleet (.+) take-off layers", name)
        if fleet:
            at = name.removesuffix("layers")
            count, low, high, up, down = (float(known[at + key]) for key in TAKE_OFF)
            yield (
                f"{fleet[1]} takes off in {count:.0f} layers, {low:.1f} to {high:.1f} m above its pads, in "
                f"{up:.1f} s, and lands in {down:.1f} s: its pads are nearer than its separation"
            )


def dense(stats: Iterable[tuple[str, float | str]]) -> Iterator[str]:
    """Yield the moves of each fleet on arcs or over something, and the pictures that are lattices."""
    for name, value in stats:
        arcs = re.fullmatch(r"fleet (.+) arcs", name)
        lattice = re.fullmatch(r"goals (.+)/(\d+) lattice", name)
        if arcs and value:
            moves = "move" if value == 1 else "moves"
            yield f"{value:.0f} {moves} of {arcs[1]} on arcs: its drones stand too near for straight lines"
        lifted = re.fullmatch(r"fleet (.+) lifted m", name)
        if lifted:
            yield f"{lifted[1]} rises by up to {at_least(float(value), 1)} m over what is in its way"
        if lattice:
            where = f"picture {lattice[2]} of {lattice[1]}"
            yield f"{where} is a lattice of {value:.0f} lights: spread evenly, they have no room"


def beside(stats: Iterable[tuple[str, float | str]]) -> Iterator[str]:
    """Yield the fleets and groups that change their flight to keep clear of others, and how."""
    words = {
        "home later": "flies home {:.1f} s later than it could",
        "sets out earlier": "sets out {:.1f} s earlier than it needs, and waits in its place",
        "led round": "flies round others, {:.1f} s longer",
    }
    for name, value in stats:
        match = re.fullmatch(rf"fleet (.+) ({'|'.join(words)})", name)
        if match:
            yield f"{match[1]} {words[match[2]].format(value)}: another one is in its way"


def display_rows(plan: VerifiedIR) -> list[tuple[str, ...]]:
    """Return a heading and one row per display: fleet, start, duration, pictures. Empty without displays."""
    rows = [
        (phase.shot, f"{track.fleet} ({len(track.coef)} drones)", *_display_row(track, phase))
        for track in plan.trajectory.fleets
        for phase in track.phases
        if phase.shot is not None
    ]
    return [("display", "fleet", "from", "lasts", "pictures"), *rows] if rows else []


def _display_row(track: FleetTrajectory, phase: Phase) -> tuple[str, ...]:
    frames_of = [s for s in track.shown if s.display == phase.shot]
    pictures = len({s.picture for s in frames_of})
    frames = "" if len(frames_of) == pictures else f", {len(frames_of)} frames"
    return as_minutes(phase.start), f"{phase.end - phase.start:.2f} s", f"{pictures}{frames}"


def headline(plan: VerifiedIR) -> str:
    """Return the numbers of displays and drones as text."""
    ir = plan.trajectory
    shows, drones = len(ir.keyframes.mission.displays), sum(len(track.coef) for track in ir.fleets)
    return f"{shows} display{'s' * (shows != 1)} of {drones} drone{'s' * (drones != 1)}"
