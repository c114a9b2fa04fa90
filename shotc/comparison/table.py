"""A comparison as a table: a heading, a row for each refiner, and rows for its shots if there are several."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import degrees, isfinite

from shotc.emit.screen import off_place, percent
from shotc.ir.comparison import ComparedShot, Comparison, Condition, Score, ShotDifference
from shotc.rounding import up

HEADING = (
    "refiner",
    "shot",
    "error mean",
    "95 %",
    "worst",
    "whole in frame",
    "four points",
    "visible",
    "jerk RMS, m/s^3",
    "turning, deg/s^3",
    "off place, m",
    "filmed",
    "rounds",
    "refined in",
)
UNKNOWN, ALL = "-", "all"
LEGEND = (
    "error: from the wanted place on screen, in half frames, over all frames that the shot frames its "
    "target; the worst is rounded up",
    "whole in frame: share of frames with the whole target in the frame, by its exact silhouette; "
    "four points: by the four points of Gebhardt and Hilliges",
    "visible: least share of a target's outline that nothing covers, in any frame",
    "jerk, turning: root mean square of the camera's jerk, and of that of its yaw and pitch; off place: mean "
    "distance from where the shot would have the camera, of shots of what moves and framings",
    "filmed: how long the shots last; rounds: how often the refiner solved them",
)


def rows(comparison: Comparison, *, seconds: bool) -> list[tuple[str, ...]]:
    """Return the heading and all rows.

    seconds : whether to include the time that each refiner took
    """
    several = len(comparison.mission.shots) > 1
    table = [HEADING, *(row for each in comparison.conditions for row in _rows(each, several=several))]
    keep = [i for i, name in enumerate(HEADING) if (several or name != "shot")]
    keep = keep if seconds else keep[:-1]
    return [tuple(row[i] for i in keep) for row in table]


def remarks(comparison: Comparison) -> list[str]:
    """Return a line for every refiner without a plan, broken promise, unrefined shot, and difference."""
    lines = []
    for each in comparison.conditions:
        lines += [
            f"{each.name} gives no plan, {d.code}: {'; '.join((d.message, *d.notes[:1]))}"
            for d in each.faults
        ]
        lines += [f"{each.name} breaks a promise, {d.code}: {d.message}" for d in each.broken]
        lines += [f"{each.name} did not refine all, {d.code}: {d.message}" for d in each.convex]
    return [*lines, *map(_remark_on, comparison.differences)]


def _remark_on(d: ShotDifference) -> str:
    at, there = (f"{time:.1f} s" for time in (d.time, d.other_time))
    there = "" if at == there else f" ({there} there)"
    return (
        f"{d.condition} differs most from {d.other} in shot {d.shot} at {at}{there}: "
        f"{d.metres:.2f} m, {d.degrees:.1f} deg; mean of metres plus degrees {d.mean:.2f}"
    )


def markdown(comparison: Comparison, *, seconds: bool) -> str:
    """Return the comparison as a section of Markdown."""
    heading, *body = rows(comparison, seconds=seconds)
    lines = [f"# {comparison.mission.name} under {conditions_of(comparison)}", ""]
    lines += [_piped(heading), _piped(("---",) * len(heading)), *map(_piped, body), ""]
    lines += [f"- {line}" for line in (*remarks(comparison), *LEGEND)]
    return "\n".join(lines) + "\n"


def conditions_of(comparison: Comparison) -> str:
    """Return the number of refiners and of smoothings in words."""
    refiners = len({each.refiner for each in comparison.conditions})
    smoothings = len({each.smoothing for each in comparison.conditions})
    text = counted(refiners, "refiner")
    return text if smoothings < 2 else f"{text}, each with {counted(smoothings, 'smoothing')}"


def counted(number: int, noun: str) -> str:
    """Return a number with its noun in the right form."""
    return f"{number} {noun}{'s' * (number != 1)}"


def _rows(each: Condition, *, several: bool) -> Iterator[tuple[str, ...]]:
    seconds = UNKNOWN if each.seconds is None else f"{each.seconds:.3f} s"
    if each.score is None:
        why = each.faults[0].code if each.faults else UNKNOWN
        yield (each.name, ALL, f"no plan ({why})", *(UNKNOWN,) * (len(HEADING) - 4), seconds)
        return
    yield (each.name, ALL, *_cells(each.score), _rounds(each.shots), seconds)
    for shot in each.shots if several else ():
        yield ("", shot.id, *_cells(shot.score), _rounds([shot]), "")


def _rounds(shots: Iterable[ComparedShot]) -> str:
    rounds = [shot.rounds for shot in shots if shot.rounds is not None]
    return str(sum(rounds)) if rounds else UNKNOWN


def _cells(score: Score) -> tuple[str, ...]:
    worst = score.error_worst
    errors = (
        score.error_mean,
        score.error_p95,
        up(worst, 4) if worst is not None and isfinite(worst) else worst,
    )
    shares = (score.in_frame, score.in_frame_four_points, score.visible)
    return (
        *(UNKNOWN if error is None else off_place(error) for error in errors),
        *(UNKNOWN if share is None else percent(share) for share in shares),
        f"{score.jerk_rms:.3f}",
        f"{degrees(score.turn_jerk_rms):.3g}",
        UNKNOWN if score.off_place is None else f"{score.off_place:.3f}",
        f"{score.duration:.2f} s",
    )


def _piped(cells: tuple[str, ...]) -> str:
    return f"| {' | '.join(cells)} |"
