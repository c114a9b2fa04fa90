"""The summary of a finished plan: its shots, how much of its limits it uses, its files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import degrees, isfinite
from pathlib import Path
from textwrap import wrap

from shotc.cli.centred import centred
from shotc.cli.console import table
from shotc.cli.exposed import exposed
from shotc.cli.show_facts import beside, dense, display_rows, headline, layered, recorded, taking_off
from shotc.emit.screen import ScreenSummary, certified, framed_targets, percent
from shotc.geom.apart import stretch
from shotc.ir.measures import OUT_OF_PICTURE, distinct_measures, measure
from shotc.ir.mission import MissionIR
from shotc.ir.parked import parked, parked_fleets
from shotc.ir.path import Deviation, from_required_positions
from shotc.ir.trajectory import Claim, VerifiedIR
from shotc.passes.refine_path.account import DONE
from shotc.passes.verify.ahead import CONSTRAINT as LOOK_AHEAD
from shotc.passes.verify.ahead import unjudged
from shotc.passes.verify.energy import ENERGY, J_PER_WH
from shotc.passes.verify.transits import ENDING as ON_TRANSITS
from shotc.planning.path.unwrapping import TURNS
from shotc.rounding import as_minutes, at_least, at_most, plain, rounded_outward

WIDTH_CHARACTERS = 100
GLUE = "\N{NO-BREAK SPACE}"
APART = "separation from "
REFINED = ".refined"
NO_MOTION_SHARE = 1e-6
"""In the unit of a limit: a smaller value is rounding, and is shown as 0."""
WHOLE = percent(1.0)
LIMITS = (
    "speed",
    "airspeed",
    "climb",
    "descent",
    "acceleration",
    "tilt",
    "thrust to weight",
    "jerk",
    "body yaw rate",
)


def summary(plan: VerifiedIR, paths: Sequence[Path], notes: Iterable[str]) -> str:
    """Return the text that ``shotc plan`` prints at its end."""
    ir, mission = plan.trajectory, plan.trajectory.keyframes.mission
    shots = f"{len(mission.shots)} shot{'s' * (len(mission.shots) != 1)}"
    if ir.fleets:
        shots = f"{shots} and {headline(plan)}" if ir.drones else headline(plan)
    tables = [rows for rows in (shot_rows(plan) if ir.drones else [], display_rows(plan)) if rows]
    return "\n".join(
        [
            f"{mission.name}: {shots}, {as_minutes(ir.end)} in the air, planned and proved",
            *(line for rows in tables for line in ("", *_indent(table(rows)))),
            "",
            *_indent(line for name, text in _facts(plan, notes) for line in _paragraph(name, text)),
            "",
            *_indent(_files(paths)),
        ]
    )


def shot_rows(plan: VerifiedIR) -> list[tuple[str, ...]]:
    """Return a heading and the rows of every shot: name, kind, start, duration, quality of its framing.

    A shot of several targets has a row for each.
    """
    kinds = {shot.id: shot.kind for shot in plan.trajectory.keyframes.mission.shots}
    flown = [(d.drone, p) for d in plan.trajectory.drones for p in d.phases if p.shot in kinds]
    targets = {shot: framed_targets(plan.certificate, shot) for shot in kinds}
    rows: list[tuple[str, ...]] = []
    for drone, phase in flown:
        assert phase.shot is not None
        own = (
            drone,
            phase.shot,
            kinds[phase.shot],
            as_minutes(phase.start),
            f"{phase.end - phase.start:.2f} s",
        )
        for i, target in enumerate(targets[phase.shot] or ("",)):
            summary = certified(plan.certificate, phase.shot, target)
            rows.append((*(own if i == 0 else ("",) * len(own)), target or "-", *_framing(summary)))
    several = any(len(names) > 1 for names in targets.values())
    in_frame = "in frame" if several else "target in frame"
    head = ("drone", "shot", "kind", "from", "lasts", "target", in_frame, "visible", "screen error", "size")
    covered = any(row[head.index("visible")] not in ("-", WHOLE) for row in rows)
    known = {"drone": len(plan.trajectory.drones) == 1, "target": not several, "visible": not covered}
    columns = [k for k, name in enumerate(head) if not known.get(name)]
    return [tuple(row[k] for k in columns) for row in (head, *rows)]


def _framing(summary: ScreenSummary) -> tuple[str, str, str, str]:
    """Return the share of frames with the whole target, the least visible share of it, its error and size."""
    return (
        "-" if summary.in_frame is None else percent(summary.in_frame),
        "-" if summary.visible is None else percent(summary.visible),
        "-" if summary.error is None else at_least(summary.error, 3),
        "-" if summary.size is None else f"{at_most(summary.size[0])} to {at_least(summary.size[1])}",
    )


def _facts(plan: VerifiedIR, notes: Iterable[str]) -> list[tuple[str, str]]:
    facts = [("limits", ", ".join(text.replace(" ", GLUE) for text in _used(plan.certificate)))]
    facts += [("closest", text) for text in _closest(plan.certificate)]
    facts += [("transits", text) for text in _passed(plan.certificate)]
    facts += [("nose", text) for text in _ahead(plan)]
    facts += [("energy", text) for text in _energy(plan)]
    facts += [("drones", text) for text in (*_together(plan), *nearest(plan), *_on_pads(plan))]
    hard = [c for c in plan.certificate if c.hard]
    counts = {method: sum(c.method == method for c in hard) for method in ("bounded", "exact", "sampled")}
    facts.append(
        (
            "proof",
            f"{len(hard)} requirements hold: {counts['bounded']} at every instant, "
            f"{counts['exact']} by arithmetic, {counts['sampled']} at every output sample",
        )
    )
    mission, flown = plan.trajectory.keyframes.mission, plan.trajectory
    facts += [("ideal", text) for text in _off_ideal(from_required_positions(mission, flown.deviations))]
    facts += [("refined", text) for text in _refined(plan)]
    facts += [("turns", text) for text in _turns(plan)]
    facts += exposed(plan)
    facts += [("smoothed", text) for text in _smoothed(mission)]
    describers = (recorded, taking_off, dense, layered, beside)
    facts += [("shows", text) for tell in describers for text in tell(flown.stats)]
    facts += [("note", text) for text in (*centred(plan.trajectory.keyframes), *_without_files(mission))]
    return facts + [("note", note) for note in notes]


def _without_files(mission: MissionIR) -> Iterator[str]:
    """Yield a note if no autopilot gets a file because a mission that lists no emitters has no origin."""
    if mission.drones and mission.origin is None and ("output", "emit") not in mission.origins.values:
        yield "there are no files for autopilots: the mission has no `world.origin`, its place on earth"


def _energy(plan: VerifiedIR) -> Iterator[str]:
    """Yield, for each drone with a known battery, the energy of the flight and its shots, and the rest."""
    claims = [claim for claim in plan.certificate if claim.constraint == ENERGY]
    for whole in (claim for claim in claims if claim.shot is None):
        power = plan.trajectory.keyframes.mission.drone(whole.subject).power
        assert power is not None
        full = power.battery / J_PER_WH
        shots = (c for c in claims if c.subject == whole.subject and c.shot is not None)
        parts = [f"{c.shot} {at_least(c.worst)} Wh" for c in shots]
        left = f"{at_most(100 * (1 - whole.worst / full), 0)} % left at landing"
        text = f"{whole.subject} takes {at_least(whole.worst)} of {full:.4g} Wh, {left}"
        yield f"{text}, {100 * power.reserve:.0f} % kept" + (f": {', '.join(parts)}" if parts else "")


def _smoothed(mission: MissionIR) -> list[str]:
    """Return how far smoothing moves the recorded tracks of targets."""
    return [
        f"the track of {target.name} lies up to {at_least(target.track.smoothed)} m from what is recorded"
        for target in mission.targets
        if target.track is not None and target.track.smoothed > 0.0
    ]


def _refined(plan: VerifiedIR) -> list[str]:
    """Return the number of refined shots and the reason for each other shot; nothing if all are refined."""
    reasons = [(k.removesuffix(REFINED), v) for k, v in plan.trajectory.stats if k.endswith(REFINED)]
    left = [f"not `{shot}`: {why}" for shot, why in reasons if why != DONE]
    return ["; ".join([f"{len(reasons) - len(left)} of {len(reasons)} shots", *left])] if left else []


def _turns(plan: VerifiedIR) -> list[str]:
    """Return the shots whose turns are flown on the curve of a method, or why they are not."""
    return [f"`{k.removesuffix(TURNS)}` {v}" for k, v in plan.trajectory.stats if k.endswith(TURNS)]


def _off_ideal(deviations: Iterable[Deviation]) -> list[str]:
    """Return how far shots deviate from their ideals: for each shot and cause, the largest deviation."""
    most: dict[tuple[str, str], float] = {}
    for d in deviations:
        most[d.shot, d.cause] = max(d.distance, most.get((d.shot, d.cause), 0.0))
    return [f"shot {s} leaves its ideal by up to {at_least(m)} m: {cause}" for (s, cause), m in most.items()]


def _used(certificate: Iterable[Claim]) -> list[str]:
    """Return how much of each limit is used. If several drones fly, name the one that uses most of it."""
    limits = [claim for claim in certificate if claim.constraint in LIMITS]
    several = len({claim.subject for claim in limits}) > 1
    texts = []
    for name in dict.fromkeys(claim.constraint for claim in limits):
        most = max((c for c in limits if c.constraint == name), key=lambda c: c.worst / c.limit)
        scale, unit = (
            (degrees(1), most.unit.replace("rad", "deg")) if "rad" in most.unit else (1.0, most.unit)
        )
        subject = (*most.drones, most.subject)[0]
        who = f" ({subject})" if several or most.drones else ""
        texts.append(f"{name} {_used_up(most.worst * scale)} of {most.limit * scale:.3g} {unit}{who}")
    return texts


def _used_up(value: float) -> str:
    """Return the used part of a limit with three digits, rounded up."""
    return f"{rounded_outward(value, upper=True, digits=3):.3g}" if value > NO_MOTION_SHARE else "0"


def _closest(claims: Sequence[Claim]) -> list[str]:
    """Return the two distances that are nearest to their limits. If several drones fly, name the drone."""
    near = [
        c
        for c in claims
        if c.unit == "m"
        and not c.upper
        and isfinite(c.worst)
        and isfinite(c.limit)
        and not c.constraint.startswith("separation")
        and not c.constraint.endswith((OUT_OF_PICTURE, ON_TRANSITS))
    ]
    near.sort(key=lambda c: c.worst - c.limit)
    several = len({c.subject for c in claims}) > 1
    return [
        f"{at_most(c.worst)} m, {c.limit:.2f} m needed: {c.constraint}"
        + "".join(f" of {drone}" for drone in c.drones or (c.subject,) * several)
        + ("" if c.time is None else f" at {as_minutes(c.time)}")
        for c in near[:2]
    ]


def _passed(claims: Sequence[Claim]) -> list[str]:
    """Return the distance on ways between shots that is nearest to its required clearance."""
    passed = [c for c in claims if c.constraint.endswith(ON_TRANSITS)]
    if not passed:
        return []
    near = min(passed, key=lambda c: c.worst - c.limit)
    drone = f" of {near.subject}" if len({c.subject for c in claims}) > 1 else ""
    name = near.constraint.removesuffix(ON_TRANSITS) + drone
    if abs(near.worst - near.limit) < NO_MOTION_SHARE:
        return [f"as near as a shot begins or ends to {name}, then {near.limit:.2f} m"]
    when = "" if near.time is None else f" at {as_minutes(near.time)}"
    return [f"{at_most(near.worst)} m from {name}{when}, {near.limit:.2f} m needed"]


def _ahead(plan: VerifiedIR) -> list[str]:
    """Return the largest angle between nose and course, the judged shots, and why others are not."""
    off = [claim for claim in plan.certificate if claim.constraint == LOOK_AHEAD]
    ir = plan.trajectory
    if ir.keyframes.mission.rules.look_ahead is None:
        return []
    texts = []
    if off:
        most = max(off, key=lambda claim: claim.worst)
        who = f" ({most.subject})" if len({claim.subject for claim in off}) > 1 else ""
        angles = f"{_used_up(degrees(most.worst))} of {degrees(most.limit):.3g} deg"
        where = ["between shots"] * any(claim.shot is None for claim in off)
        where += [f"in `{claim.shot}`" for claim in off if claim.shot is not None]
        texts.append(f"up to {angles} off the course{who}: {', '.join(where)}")
    reasons: dict[str, list[str]] = {}
    for bound in unjudged(ir.keyframes.mission, ir.drones):
        reasons.setdefault(bound.why, []).append(f"`{bound.shot}`")
    return [*texts, *(f"not judged in {', '.join(shots)}: {why}" for why, shots in reasons.items())]


def _together(plan: VerifiedIR) -> list[str]:
    """Return, if several drones fly, the smallest distance of two, and which drone is in whose picture."""
    apart = [c for c in plan.certificate if c.constraint.startswith(APART) and not c.drones]
    if not apart:
        return []
    near = min(apart, key=lambda c: c.worst)
    other = near.constraint.removeprefix(APART)
    text = f"{near.subject} and {other} come nearest, {at_most(near.worst)} m, {near.limit:.2f} m needed"
    return [text + ("" if near.time is None else f", at {as_minutes(near.time)}") + f"; {_pictures(plan)}"]


def _on_pads(plan: VerifiedIR) -> Iterator[str]:
    """Yield the drones and fleets that stay on their pads, and how near the flying ones come to them."""
    ir = plan.trajectory
    names = [f"{track.drone} films nothing and stands on its pad" for track in parked(ir)]
    names += [
        f"{fleet.kind} {fleet.name} shows nothing and stands on its pads" for fleet in parked_fleets(ir)
    ]
    who = [*(track.drone for track in parked(ir)), *(fleet.name for fleet in parked_fleets(ir))]
    for name, text in zip(who, names, strict=True):
        near = [claim for claim in plan.certificate if claim.constraint == APART + name]
        least = min(near, key=lambda claim: claim.worst)
        yield f"{text}, {least.worst:.2f} m from the nearest, {least.limit:.2f} m needed"


def _pictures(plan: VerifiedIR) -> str:
    rules = plan.trajectory.keyframes.mission.rules
    if rules.visibility == "off":
        return "pictures are not judged"
    angle = rules.half_angle
    where = "in the picture" if angle is None else f"within {plain(degrees(angle), 6)} deg of the axis"
    seen = [
        f"{c.constraint.removesuffix(OUT_OF_PICTURE)} is {where} of {c.subject} (shot {c.shot})"
        for c in plan.certificate
        if c.constraint.endswith(OUT_OF_PICTURE) and not c.holds
    ]
    return ", ".join(seen) or f"none is {where} of another"


def _files(paths: Sequence[Path]) -> list[str]:
    folder = paths[0].parent
    return [
        *_paragraph("wrote", f"{folder}/: {', '.join(path.name for path in paths)}"),
        f"next      shotc view {folder / 'plan.json'}",
    ]


def _paragraph(name: str, text: str) -> list[str]:
    """Wrap the text of a fact after its name. Words joined by GLUE stay on one line."""
    lines = wrap(text, WIDTH_CHARACTERS - 12, break_long_words=False, break_on_hyphens=False)
    return [f"{name if i == 0 else '':<9} {line.replace(GLUE, ' ')}" for i, line in enumerate(lines)]


def _indent(lines: Iterable[str]) -> list[str]:
    return ["  " + line for line in lines]


PAIR = 2


def nearest(plan: VerifiedIR) -> Iterator[str]:
    """Yield, for each fleet and each pair of fleets, the two nearest drones, their distance, and the time."""
    for claim in plan.certificate:
        if len(claim.drones) == PAIR:
            yield _pair(plan, claim)


def _pair(plan: VerifiedIR, claim: Claim) -> str:
    reached, needed = measure(claim.worst, claim.unit), measure(claim.limit, claim.unit)
    when = "" if claim.time is None else f", at {as_minutes(claim.time)}"
    text = f"{' and '.join(claim.drones)} come nearest, {reached}, {needed} needed{when}"
    if claim.constraint == "separation on pads":
        return f"{text} while one stands on its pad"
    if claim.constraint not in ("separation", "separation in the air"):
        return text
    apart = plan.trajectory.keyframes.mission.fleet(claim.subject).apart
    scale = stretch(apart)
    if scale == 1 and apart.shape == "ellipsoid":
        return text
    return f"{text}; heights count {scale:.2g} times ({apart.shape})"


WAYS = {"bounded": "every instant", "exact": "arithmetic", "sampled": "output samples"}
HEADING = ("", "claim", "asked", "worst", "at", "known by")


def certificate_text(certificate: Sequence[Claim]) -> str:
    """Return one table for each drone's whole flight and one for each of its shots."""
    parts: list[str] = []
    for subject, shot in dict.fromkeys((c.subject, c.shot) for c in certificate):
        claims = [c for c in certificate if (c.subject, c.shot) == (subject, shot)]
        parts.append(f"{subject}, " + ("whole flight" if shot is None else f"shot {shot}"))
        parts += ["  " + line for line in table([HEADING, *_rows(claims)])]
        parts.append("")
    return "\n".join(parts[:-1])


def _rows(claims: Sequence[Claim]) -> Iterator[tuple[str, ...]]:
    for claim in claims:
        yield (
            mark(claim),
            *_values(claim),
            "" if claim.time is None else as_minutes(claim.time),
            WAYS[claim.method] + (f", {' and '.join(claim.drones)}" if claim.drones else ""),
        )


def _values(claim: Claim) -> tuple[str, str, str]:
    """Return the constraint of a claim, its limit and its worst value as texts."""
    if claim.constraint.endswith(OUT_OF_PICTURE) and claim.unit == "m" and isfinite(claim.worst):
        side = "outside" if claim.worst >= 0.0 else "inside"
        return claim.constraint, "outside the frame", f"{measure(abs(claim.worst), 'm')} {side}"
    worst, limit = measure(claim.worst, claim.unit), measure(claim.limit, claim.unit)
    if not claim.holds:
        worst, limit = distinct_measures(claim.worst, claim.limit, claim.unit)
    limit_text = f"{'<=' if claim.upper else '>='} {limit}" if isfinite(claim.limit) else "-"
    return claim.constraint, limit_text, worst if isfinite(claim.worst) else "-"


def mark(claim: Claim) -> str:
    """Return the word for the result of a claim: ok, BROKEN, missed, or "" if it has no limit."""
    if not claim.holds:
        return "BROKEN" if claim.hard else "missed"
    return "ok" if isfinite(claim.limit) else ""
