"""Diagnostics of broken claims: the limit's line, the shot's line, time, place and remedy."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from shotc.diag.model import Diagnostic, Label
from shotc.ir.allow import HIDDEN
from shotc.ir.measures import OUT_OF_PICTURE, distinct_measures
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.origin import KeyPath
from shotc.ir.phases import Phase
from shotc.ir.show import Display
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.advice import REPLAN, Rule, advice, wind_note
from shotc.passes.verify.ahead import CONSTRAINT as LOOK_AHEAD
from shotc.passes.verify.energy import energy_note
from shotc.passes.verify.fleets.burning import PYRO
from shotc.passes.verify.fleets.pyro_advice import pyro_advice
from shotc.passes.verify.hidden import hidden_by, nowhere_seen
from shotc.passes.verify.lost_time import BETWEEN, BETWEEN_SHOTS, WAY
from shotc.passes.verify.meeting import meeting
from shotc.passes.verify.nearby import file_labels, nearest_part
from shotc.passes.verify.paced import CONSTRAINT as PACE
from shotc.passes.verify.paced import pace_note
from shotc.passes.verify.passing import reported_passes
from shotc.passes.verify.promises import OUTLINES, PROMISES, bends, broken_promise, promise_help, target_of
from shotc.passes.verify.sighting import sighted
from shotc.passes.verify.transits import ENDING as PASSED
from shotc.passes.verify.visible import AT_FIRST, AT_LAST, IN_SIGHT, VISIBLE
from shotc.passes.verify.waits import LATE, UNJUDGED, WAITED
from shotc.rounding import plain, up

RULES = {
    "speed": Rule("V001", 1.0),
    "airspeed": Rule("V001"),
    "climb": Rule("V001", 1.0),
    "descent": Rule("V001", 1.0),
    "acceleration": Rule("V002", 1 / 2),
    "jerk": Rule("V003", 1 / 3),
    "tilt": Rule("V053"),
    "thrust to weight": Rule("V054"),
    "body yaw rate": Rule("V004", 1.0),
    "body yaw acceleration": Rule("V004", 1 / 2),
    "gimbal pitch min": Rule("V005"),
    "gimbal pitch max": Rule("V005"),
    "gimbal yaw min": Rule("V005"),
    "gimbal yaw max": Rule("V005"),
    "gimbal pitch rate": Rule("V006", 1.0),
    "gimbal yaw rate": Rule("V006", 1.0),
    "gimbal pitch acceleration": Rule("V006", 1 / 2),
    "gimbal yaw acceleration": Rule("V006", 1 / 2),
    "field of view min": Rule("V018"),
    "field of view max": Rule("V018"),
    "zoom rate": Rule("V060", 1.0),
    "ground clearance": Rule("V009"),
    "height above ground": Rule("V047"),
    "distance from terrain": Rule("V009"),
    LOOK_AHEAD: Rule("V056"),
    "distance from home": Rule("V012", help=REPLAN),
    "rate at start and end": Rule("V012", help=REPLAN),
    "endurance": Rule("V013"),
    "energy": Rule("V055"),
    "times flown": Rule("V015", help=REPLAN),
    "error of duration": Rule("V015", help=REPLAN),
    "error of start": Rule("V015", help=REPLAN),
    "start too early": Rule("V015", help=REPLAN),
    "separation": Rule("V022"),
    "pictures left out": Rule("V015", help=REPLAN),
    "pictures out of order": Rule("V015", help=REPLAN),
    "lack of hold": Rule("V015", help=REPLAN),
    "excess of hold": Rule("V015", help=REPLAN),
    "display without a picture": Rule("V015", help=REPLAN),
    "error of period": Rule("V015", help=REPLAN),
    "dark lights of a picture": Rule("V064", help=REPLAN),
    "light off its colour": Rule("V064", help=REPLAN),
    "light between pictures": Rule("V064", help=REPLAN),
    "effects not as asked": Rule("V064", help=REPLAN),
    "effect off its colours": Rule("V064", help=REPLAN),
    "effect off its times": Rule("V064", help=REPLAN),
    "effect off its place": Rule("V064", help=REPLAN),
    "effects of a file": Rule("V064", help=REPLAN),
    "light off its picture": Rule("V064", help=REPLAN),
    "picture without lights": Rule("V064", help=REPLAN),
    "picture off its place": Rule("V064", help=REPLAN),
    "picture off its size": Rule("V064", help=REPLAN),
    "pictures of a file": Rule("V064", help=REPLAN),
    "error of transition": Rule("V015", help=REPLAN),
    "transitions without a time": Rule("V015", help=REPLAN),
    "error of moment": Rule("V015", help=REPLAN),
    "error of wave": Rule("V015", help=REPLAN),
    "distance from keyframes": Rule("V016", help=REPLAN),
    "delay of keyframes": Rule("V016", help=REPLAN),
    "keyframes out of order": Rule("V016", help=REPLAN),
    "distance from its path": Rule("V044", help=REPLAN),
    "distance from its ends": Rule("V044", help=REPLAN),
    "distance from its place": Rule("V044", help=REPLAN),
    "detour where it is free": Rule("V044", help=REPLAN),
    "way between keyframes": Rule("V044", help=REPLAN),
    "detour between keyframes": Rule("V044", help=REPLAN),
    "lens off its keyframes": Rule("V045", help=REPLAN),
    "direction off its keyframes": Rule("V045", help=REPLAN),
    "turn off its keyframes": Rule("V045", help=REPLAN),
    "lens between keyframes": Rule("V045", help=REPLAN),
    "lens off its shot": Rule("V045", help=REPLAN),
    "direction between keyframes": Rule("V045", help=REPLAN),
    "direction off its aim": Rule("V045", help=REPLAN),
    "body off its camera": Rule("V045", help=REPLAN),
    "turn of a free body": Rule("V045", help=REPLAN),
    "shots out of order": Rule("V015", help=REPLAN),
    PACE: Rule("V065", help=REPLAN),
    **dict.fromkeys((BETWEEN, BETWEEN_SHOTS, WAY, WAITED, LATE, UNJUDGED), Rule("V066", help=REPLAN)),
    "drift from the vertical": Rule("V017", help=REPLAN),
    "depth below home": Rule("V017", help=REPLAN),
    "frames without their target": Rule("V024", help=REPLAN),
    "frames of another target": Rule("V024", help=REPLAN),
    "keyframes without a time": Rule("V024", help=REPLAN),
    "reference off its keyframes": Rule("V024", help=REPLAN),
    "reference off its composition": Rule("V024", help=REPLAN),
}

STARTING = {
    "zone ": Rule("V007"),
    "target ": Rule("V010"),
    "jump of ": Rule("V011", help=REPLAN),
    "drift at ": Rule("V016", help=REPLAN),
    "separation ": Rule("V022"),
    "lights outside ": Rule("V057"),
    PYRO: Rule("V059"),
    "distance from scene": Rule("V052"),
    "distance from buildings": Rule("V052"),
}

ENDING = {
    PASSED: Rule("V035"),
    " outside the flight": Rule("V059"),
    " in frame": Rule("V019"),
    " screen error": Rule("V020"),
    " size smallest": Rule("V021"),
    " size largest": Rule("V021"),
    VISIBLE: Rule("V028"),
    AT_FIRST: Rule("V029"),
    AT_LAST: Rule("V029"),
}

ESTIMATED = frozenset((BETWEEN, BETWEEN_SHOTS, WAY, WAITED, LATE))
"""Constraints that are compared with an estimate, not at the output rate."""

UNKNOWN = {
    "V024": "is unknown: there is none",
    "V016": "is unknown: the keyframe is not reached in its shot",
}
"""What a message says where a claim has no finite worst value."""

SOFT = {" in frame": "V030", VISIBLE: "V031", IN_SIGHT: "V050"}


def report(ir: TrajectoryIR, claims: tuple[Claim, ...]) -> Iterator[Diagnostic]:
    """Yield one diagnostic per broken claim: an error where it is hard, else a warning.

    Preferences on drones' pictures are reported once a shot, and clearances of transfers once a transfer.
    """
    yield from reported_passes(ir, claims)
    for claim in claims:
        if claim.holds or claim.constraint.endswith(PASSED):
            continue
        if claim.constraint.endswith(OUT_OF_PICTURE):
            seen = _seen_with(claim, claims)
            if claim is seen[0]:
                yield sighted(ir, seen)
        elif claim.hard:
            yield _broken(ir, claim, claims)
        else:
            code = next((code for end, code in SOFT.items() if claim.constraint.endswith(end)), None)
            if code is not None and not _on_purpose(ir.keyframes.mission, claim, code, claims):
                yield _lost(ir, claim, code)


def _seen_with(claim: Claim, claims: tuple[Claim, ...]) -> tuple[Claim, ...]:
    """Return the broken claims on pictures that are reported together with a given one."""
    if claim.hard:
        return (claim,)
    return tuple(
        c
        for c in claims
        if not c.holds and not c.hard and c.constraint.endswith(OUT_OF_PICTURE) and c.shot == claim.shot
    )


def rule_of(constraint: str, mission: MissionIR) -> Rule:
    """Return how a constraint is reported; its text contains names of zones and targets."""
    if constraint in RULES:
        return RULES[constraint]
    for end, rule in ENDING.items():
        if constraint.endswith(end):
            return rule
    start = next(start for start in STARTING if constraint.startswith(start))
    if start == "zone ":
        name = constraint.removeprefix(start).removesuffix(" at home")
        if any(zone.name == name and zone.keep == "in" for zone in mission.zones):
            return Rule("V008")
    return STARTING[start]


def _broken(ir: TrajectoryIR, claim: Claim, certificate: tuple[Claim, ...]) -> Diagnostic:
    mission = ir.keyframes.mission
    rule = rule_of(claim.constraint, mission)
    met = meeting(ir, claim) if rule.code == "V022" else None
    if met is not None:
        return met
    phase = _phase_of(ir, claim)
    notes = [*_notes(claim, phase), *_counts_from(mission, claim)]
    shot = _shot(mission, claim.shot)
    if rule.code in PROMISES and isinstance(shot, Shot):
        message = broken_promise(claim, rule.code)
        notes += bends(ir, shot.id)
        if rule.code in OUTLINES:
            notes += hidden_by(ir, claim, target_of(claim, rule.code))
        help_ = promise_help(claim, rule.code, shot, certificate)
    else:
        message = f"{_who(claim)}: {state_of(claim, rule.code)}"
        causes = [wind_note(mission, claim), energy_note(claim, certificate)]
        notes += filter(None, [*causes, *nearest_part(mission, claim), *pace_note(ir, claim)])
        help_ = pyro_advice(ir, claim) if rule.code == "V059" else advice(mission, claim, rule, phase)
    limit = f"{side_of(claim)} {distinct_measures(claim.worst, claim.limit, claim.unit)[1]}"
    labels = (*_labels(mission, claim, phase, limit), *file_labels(mission, claim))
    return Diagnostic(rule.code, message, labels, tuple(notes), help_)


def state_of(claim: Claim, code: str) -> str:
    """Return the worst value and its limit, with enough digits to distinguish them."""
    reached, limit = distinct_measures(claim.worst, claim.limit, claim.unit)
    state = f"is {reached}" if isfinite(claim.worst) else UNKNOWN.get(code, "has no bound")
    return (
        f"{_name(claim, code)} {state}, {side_of(claim)} {limit} is {'allowed' if claim.upper else 'needed'}"
    )


def side_of(claim: Claim) -> str:
    """Return the words before a limit."""
    return "at most" if claim.upper else "at least"


def _on_purpose(mission: MissionIR, claim: Claim, code: str, claims: tuple[Claim, ...]) -> bool:
    """Return whether the target of a claim is larger than the frame by request, or may be hidden.

    A target hidden in most frames has a warning already.
    """
    shot = mission.shot(claim.shot)
    if code != "V030":
        on_purpose = code == "V031" and _mostly_hidden(claim, claims)
        return on_purpose or HIDDEN in shot.allow
    target = claim.constraint.removesuffix(" in frame")
    promised = next((s.size for s in shot.subjects if s.target == target), shot.size)
    return promised is not None and promised > 1.0


def _mostly_hidden(claim: Claim, claims: tuple[Claim, ...]) -> bool:
    """Return whether the target of a claim on visibility is hidden in most frames of its shot."""
    name = claim.constraint.removesuffix(VISIBLE) + IN_SIGHT
    return any(c.constraint == name and c.shot == claim.shot and not c.holds for c in claims)


_ASIDE = "film from another side or from higher up, so that nothing stands on the line of sight"
_LOST_HELP = {
    "V030": (
        "film from farther away or through a wider lens there; `require: {in_frame: ...}` makes it an error"
    ),
    "V031": _ASIDE,
    "V050": f"{_ASIDE}, or write `allow: [hidden-subject]` in the shot to accept it",
}


def _lost(ir: TrajectoryIR, claim: Claim, code: str) -> Diagnostic:
    mission = ir.keyframes.mission
    target = next(claim.constraint.removesuffix(end) for end in SOFT if claim.constraint.endswith(end))
    share = f"{100 * (1 - claim.worst):.3g} %"
    state = {
        "V030": f"not whole in frame in {share} of",
        "V031": f"hidden by up to {plain(up(100 * (1 - claim.worst), 1))} % of its outline in",
        "V050": f"hidden by more than half in {share} of",
    }[code]
    phase = _phase_of(ir, claim)
    by = [] if code == "V030" else list(hidden_by(ir, claim, target))
    if code == "V050" and phase is not None:
        by += nowhere_seen(mission, phase)
    return Diagnostic(
        code,
        f"{target} is {state} shot `{claim.shot}`",
        labels=(mission.origins.key(claim.path),),
        notes=(*_notes(claim, phase), *by),
        help=_LOST_HELP[code],
    )


def _labels(mission: MissionIR, claim: Claim, phase: Phase | None, limit: str) -> tuple[Label, ...]:
    first = limit_label(mission, claim, limit)
    shot = _shot(mission, claim.shot or (phase.shot if phase else None))
    if shot is None:
        return (first,)
    second = mission.origins.key(shot.path, "broken in this shot")
    return (first,) if second.span == first.span else (first, second)


def limit_label(mission: MissionIR, claim: Claim, text: str) -> Label:
    """Return a label on the limit of a claim."""
    find = mission.origins.key if _is_element(mission, claim.path) else mission.origins.value
    return find(claim.path, text)


def _is_element(mission: MissionIR, path: KeyPath) -> bool:
    # An element spans many lines, so the label is on its name. A limit is a number, with a label of its own.
    films = (mission.zones, mission.drones, mission.every_target, mission.shots)
    named = (*films, mission.fleets, mission.displays)
    return path in {element.path for elements in named for element in elements}


def _notes(claim: Claim, phase: Phase | None) -> Iterator[str]:
    if claim.time is not None:
        where = f"worst at t = {claim.time:.3f} s"
        if phase is not None:
            name = f"shot `{phase.shot}`" if phase.shot else f"the {phase.name} phase"
            where += f", {claim.time - phase.start:.3f} s into {name}"
        if claim.position is not None:
            where += ", at ({:.2f}, {:.2f}, {:.2f}) m".format(*claim.position)
        yield where
    if claim.method == "bounded":
        yield "proved over continuous time"
    elif claim.method == "sampled" and claim.constraint not in ESTIMATED:
        yield "found at the output rate"


def _counts_from(mission: MissionIR, claim: Claim) -> Iterator[str]:
    """Yield what the distance of a claim counts from, where that is not the target's body."""
    for target in mission.targets:
        if claim.constraint.startswith(f"target {target.name}") and target.counts_from:
            yield target.counts_from


def _name(claim: Claim, code: str) -> str:
    if code in ("V007", "V010"):
        return f"the distance of the body from {claim.constraint}"
    if code == "V008":
        return f"the margin of the body inside {claim.constraint}"
    return claim.constraint if claim.shot is None else f"{claim.constraint} of shot `{claim.shot}`"


def _phase_of(ir: TrajectoryIR, claim: Claim) -> Phase | None:
    phases = {t.drone: t.phases for t in ir.drones} | {t.fleet: t.phases for t in ir.fleets}
    own = phases.get(claim.subject, ())
    if claim.shot is not None:
        return next((p for p in own if p.shot == claim.shot), None)
    if claim.time is None:
        return None
    return next((p for p in own if p.start <= claim.time <= p.end), None)


def _shot(mission: MissionIR, name: str | None) -> Shot | Display | None:
    shots: tuple[Shot | Display, ...] = (*mission.shots, *mission.displays)
    return next((s for s in shots if s.id == name), None)


def _who(claim: Claim) -> str:
    """Return the drone, or the fleet with the drones, that breaks a claim."""
    if not claim.drones:
        return claim.subject
    return f"{' and '.join(claim.drones)} of {claim.subject}"
