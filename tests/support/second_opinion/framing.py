"""framing.csv, the claims of pictures and the mission's promises, by silhouettes of our own."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from tests.support.second_opinion.case import Case, Finding, Findings, column
from tests.support.second_opinion.flight import Array, Phase, polynomial
from tests.support.second_opinion.picture import Camera, Picture, picture
from tests.support.second_opinion.quantities import number
from tests.support.second_opinion.sight import covered, hidden

DIGITS = 2e-8  # half frames by which nine digits of a place on screen, and of its time, may differ
OUTLINE = 4e-4  # of the size, by which an outline of straight lines between rim points is smaller
EDGE = 3e-4  # half frames about the frame's edge in which either answer is right
SOME = 8  # rows of a subject whose outline is looked at
SHARE_OFF = 0.1  # of an outline, by which few places on it may be off
DENSE = 50.0  # samples a second where a claim is for every instant
FRAMES = {
    "center": (0.0, 0.0), "left-third": (-1 / 3, 0.0), "right-third": (1 / 3, 0.0),
    "upper-third": (0.0, 1 / 3), "lower-third": (0.0, -1 / 3),
}  # fmt: skip


class Seen(NamedTuple):
    """A subject of a shot at some times: what is on screen, and what is wanted there, NaN where nothing."""

    t: Array
    picture: Picture
    wanted: Array
    counts: Array

    @property
    def error(self) -> Array:
        return np.linalg.norm(self.picture.centre - self.wanted, axis=1)


def subjects(case: Case) -> Iterator[tuple[str, Phase, str]]:
    """Yield drone, phase and target of every subject that is filmed."""
    for flight in case.flights.values():
        for phase in flight.phases:
            if phase.shot is not None:
                named = dict.fromkeys(f["target"] for f in flight.framing if f["shot"] == phase.shot)
                yield from ((flight.drone, phase, target) for target in named)


def seen(case: Case, drone: str, phase: Phase, target: str, t: Array) -> Seen:
    """Return what is seen of a target at some times of a shot."""
    flight, solid = case.flights[drone], case.mission.targets[target]
    camera = Camera.of(flight.at(t), float(case.drones[drone]["aspect"]))
    wanted = np.full((len(t), 2), np.nan)
    counts = np.zeros(len(t), dtype=bool)
    for entry in flight.framing:
        if (entry["shot"], entry["target"]) != (phase.shot, target):
            continue
        within = (t >= entry["start"] - 1e-9) & (t <= entry["end"] + 1e-9)
        counts |= within
        if entry["reference"] is not None and within.any():
            curve = polynomial(entry["reference"])
            wanted[within] = curve(np.clip(t[within], curve.x[0], curve.x[-1]))
    return Seen(t, picture(camera, solid.at(t), solid.outline(t)), wanted, counts)


def framing_table(case: Case) -> Findings:
    """Every row of framing.csv says what our own projection finds."""
    expected = 0
    for drone, phase, target in subjects(case):
        mine = _rows_of(case, drone, phase, target)
        t = column(mine, "t_s")
        expected += len(mine)
        first, last = (
            np.ceil(phase.start * case.mission.rate - 1e-6),
            np.ceil(phase.end * case.mission.rate - 1e-6),
        )
        if abs(len(mine) - (last - first)) > 1:
            yield Finding(f"rows of {target}", str(phase.shot), len(mine), float(last - first))
        if mine:
            yield from _rows(case, seen(case, drone, phase, target, t), mine, f"{phase.shot} {target}")
    if expected != len(case.framing):
        yield Finding("rows of framing.csv", "mission", len(case.framing), expected)


def hiding(case: Case) -> Findings:
    """Every row of framing.csv says what hides its subject."""
    for drone, phase, target in subjects(case):
        mine = _rows_of(case, drone, phase, target)
        if mine:
            t = column(mine, "t_s")
            yield from _hidden(case, mine, drone, target, t, str(phase.shot))
            yield from _covered(case, mine, drone, target, t, str(phase.shot))


def _rows_of(case: Case, drone: str, phase: Phase, target: str) -> list[dict[str, str]]:
    return [r for r in case.framing if (r["drone"], r["shot"], r["target"]) == (drone, phase.shot, target)]


def _rows(case: Case, found: Seen, rows: list[dict[str, str]], subject: str) -> Findings:
    pairs = {
        "u": (found.picture.centre[:, 0], DIGITS),
        "v": (found.picture.centre[:, 1], DIGITS),
        "u_ref": (found.wanted[:, 0], DIGITS),
        "v_ref": (found.wanted[:, 1], DIGITS),
        "size": (found.picture.size, OUTLINE),
    }
    for name, (wanted, share) in pairs.items():
        told = column(rows, name)
        off = (
            np.abs(told - wanted)
            > share * np.maximum(1.0 if share == DIGITS else 0.0, np.abs(wanted)) + DIGITS
        )
        off |= np.isnan(told) != np.isnan(wanted)
        if off.any():
            k = int(off.argmax())
            yield Finding(f"column {name}", subject, float(told[k]), float(wanted[k]), float(found.t[k]))
    whole = column(rows, "in_frame") == 1
    sure = np.abs(found.picture.inside) > EDGE
    wrong = sure & (whole != (found.picture.inside > 0))
    if wrong.any():
        k = int(wrong.argmax())
        yield Finding(
            "column in_frame", subject, float(whole[k]), float(found.picture.inside[k]), float(found.t[k])
        )


def _hidden(case: Case, rows: list[dict[str, str]], drone: str, target: str, t: Array, shot: str) -> Findings:
    told = column(rows, "occluded") == 1
    surely, maybe = hidden(case, drone, target, t)
    wrong = (surely & ~told) | (told & ~maybe)
    if wrong.any():
        k = int(wrong.argmax())
        yield Finding("column occluded", f"{shot} {target}", float(told[k]), float(surely[k]), float(t[k]))


def _covered(
    case: Case, rows: list[dict[str, str]], drone: str, target: str, t: Array, shot: str
) -> Findings:
    few = slice(None, None, max(1, len(t) // SOME))
    told = column(rows, "covered")[few]
    surely, maybe = covered(case, drone, target, t[few])
    off = np.maximum(surely - told, told - maybe)
    if (off > SHARE_OFF).any():
        k = int(off.argmax())
        yield Finding(
            "column covered", f"{shot} {target}", float(told[k]), float(surely[k]), float(t[few][k])
        )


def picture_claims(case: Case) -> Findings:
    """What is claimed of pictures, at every tick, and densely where it is claimed of every instant."""
    claims: dict[tuple[str, str | None], dict[str, Any]] = {
        (c["constraint"], c["shot"]): c for c in case.plan["certificate"] if c["shot"] is not None
    }
    for drone, phase, target in subjects(case):
        ticks = np.unique([phase.start, *ticks_of(case, phase), phase.end])
        at_ticks = seen(case, drone, phase, target, ticks)
        even = np.linspace(phase.start, phase.end, int((phase.end - phase.start) * DENSE) + 2)
        always = seen(case, drone, phase, target, np.unique(np.concatenate([ticks, even])))
        for name in ("in frame", "screen error", "size smallest", "size largest"):
            claim = claims.get((f"{target} {name}", phase.shot))
            if claim is not None:
                looked = always if claim["method"] == "bounded" else at_ticks
                yield from _claim(claim, name, looked, f"{phase.shot} {target}")


def ticks_of(case: Case, phase: Phase) -> Array:
    """Return the ticks of the output clock in a phase."""
    rate = case.mission.rate
    return np.arange(np.ceil(phase.start * rate - 1e-9), np.floor(phase.end * rate + 1e-9) + 1) / rate


def _claim(claim: dict[str, Any], name: str, found: Seen, subject: str) -> Findings:
    worst = float(claim["worst"])
    t, some = found.t[found.counts], Picture(*(part[found.counts] for part in found.picture))
    if not len(t):
        return
    if name == "in frame":
        surely_out = (some.inside < -EDGE).mean()
        surely_in = (some.inside > EDGE).mean()
        grain = 0.0 if worst == 1.0 else 2.0 / len(t) + 0.01
        if not surely_in - grain <= worst <= 1.0 - surely_out + grain:
            yield Finding(
                f"claimed {name}", subject, float(1.0 - surely_out), worst, float(t[some.inside.argmin()])
            )
        return
    values = {
        "screen error": found.error[found.counts],
        "size smallest": -some.size,
        "size largest": some.size,
    }[name]
    worst = -worst if name == "size smallest" else worst
    if np.isnan(values).all():
        return
    value = float(np.nanmax(values))
    slack = 1e-6 + (OUTLINE * abs(value) if "size" in name else 0.0)
    if value - worst > slack or (claim["method"] != "bounded" and worst - value > slack + 0.02 * abs(value)):
        yield Finding(f"claimed {name}", subject, value, worst, float(t[np.nanargmax(values)]))


def promises(case: Case) -> Findings:
    """What a shot requires is true of its frames."""
    asked = {shot["id"]: shot.get("require", {}) for shot in case.mission.shots}
    for drone, phase, target in subjects(case):
        require = asked[str(phase.shot)]
        found = seen(case, drone, phase, target, ticks_of(case, phase))
        subject = f"{phase.shot} {target}"
        if "in_frame" in require:
            share = float((found.picture.inside[found.counts] >= -EDGE).mean())
            if share < number(require["in_frame"]) - 1e-9:
                yield Finding("required in_frame", subject, share, number(require["in_frame"]))
        if (
            "screen_error" in require
            and float(np.nanmax(found.error)) > number(require["screen_error"]) + 1e-6
        ):
            yield Finding(
                "required screen_error",
                subject,
                float(np.nanmax(found.error)),
                number(require["screen_error"]),
            )
        if "size" in require:
            least, most = (number(part) for part in require["size"])
            low, high = float(np.nanmin(found.picture.size)), float(np.nanmax(found.picture.size))
            if low < least * (1 - OUTLINE):
                yield Finding("required size", subject, low, least)
            if high > most * (1 + OUTLINE):
                yield Finding("required size", subject, high, most)


def frames_asked(case: Case) -> Findings:
    """A keyframe that names a place on screen has its target there."""
    for shot in case.mission.shots:
        for k, keyframe in enumerate(shot.get("keyframes", ())):
            frame, target = keyframe.get("frame"), keyframe.get("look_at")
            place = FRAMES.get(frame) if isinstance(frame, str) else frame
            if place is None or not isinstance(target, str):
                continue
            ((flight, phase),) = (
                (f, p) for f in case.flights.values() for p in f.phases if p.shot == shot["id"]
            )
            (mark,) = (m for m in flight.keyframes if (m["shot"], m["index"]) == (shot["id"], k))
            found = seen(case, flight.drone, phase, target, np.array([mark["time"]]))
            off = float(np.linalg.norm(found.picture.centre[0] - [number(part) for part in place]))
            if not off <= 0.05:
                yield Finding("frame of keyframe", f"{shot['id']} keyframe {k + 1}", off, 0.0, mark["time"])
