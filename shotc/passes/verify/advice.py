"""Remedies for broken claims, in the terms and numbers of the mission file."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from shotc.ir.measures import USUAL_DIGITS, enough, measure
from shotc.ir.mission import MissionIR
from shotc.ir.phases import Phase
from shotc.ir.trajectory import Claim
from shotc.rounding import at_least, rounded_outward

REPLAN = "plan the mission again"

_SECTIONS = ("limits", "gimbal", "rules")
_ENDS = {" min": "the first value of ", " max": "the second value of "}


@dataclass(frozen=True, slots=True)
class Rule:
    """How a kind of claim is reported.

    power : the duration grows with (worst / limit) ** power to reduce the value to its limit; 0 where it does
        not help
    """

    code: str
    power: float = 0.0
    help: str = ""


def advice(mission: MissionIR, claim: Claim, rule: Rule, phase: Phase | None) -> str:
    """Return the change that makes a claim hold; ``phase`` is the one in which it is broken."""
    if rule.help or not isfinite(claim.worst):
        return rule.help or REPLAN
    special = _on_a_way(claim, rule.code, phase) or _in_space(claim, rule.code)
    if special:
        return special
    setting = _setting(mission, claim)
    if rule.power and claim.limit > 0 and phase is not None and phase.shot is not None:
        stretch = max(1.0, claim.worst / claim.limit) ** rule.power
        longer = at_least((phase.end - phase.start) * stretch, 1)
        time = f"give shot `{phase.shot}` {longer} s or more"
        if claim.drones:
            times = rounded_outward(stretch, upper=True, digits=USUAL_DIGITS)
            time = f"give the moves of shot `{phase.shot}` {times:.4g} times their time"
        return f"{time}, or {setting}; then plan again" if setting else f"{time}; then plan again"
    return f"{setting}, or {REPLAN}" if setting else REPLAN


def wind_note(mission: MissionIR, claim: Claim) -> str:
    """Return what the wind takes off the limit of a claim, or its speed; empty if neither applies."""
    if claim.constraint == "airspeed":
        return f"it counts through the air, which moves at {measure(mission.wind, claim.unit)}"
    if not _is_in_wind(mission, claim):
        return ""
    written, wind = measure(claim.limit + mission.wind, claim.unit), measure(mission.wind, claim.unit)
    return f"the limit is the drone's {written} less {wind} of wind"


def _is_in_wind(mission: MissionIR, claim: Claim) -> bool:
    return claim.constraint == "speed" and mission.wind > 0


def _setting(mission: MissionIR, claim: Claim) -> str:
    """Return which number of the mission to change to what; empty where the limit is none of these."""
    keys = [str(key) for key in claim.path[-2:]]
    if len(keys) < 2 or keys[0] not in _SECTIONS:
        return ""
    which = next((text for end, text in _ENDS.items() if claim.constraint.endswith(end)), "")
    verb = "raise" if claim.upper else "lower"
    worst, remark = enough(claim), ""
    if _is_in_wind(mission, claim):
        total = rounded_outward(claim.worst + mission.wind, upper=True, digits=USUAL_DIGITS)
        worst = f"{total:.{USUAL_DIGITS}g} {claim.unit}"
        remark = f" ({measure(mission.wind, claim.unit)} of wind are taken off)"
    return f"{verb} {which}`{'.'.join(keys)}` to {worst}{remark}"


def _on_a_way(claim: Claim, code: str, phase: Phase | None) -> str:
    """Return a remedy for a transfer, where a lower clearance would lead the planner even nearer."""
    if code != "V010" or claim.drones or phase is None or phase.shot is not None:
        return ""
    if phase.name == "transit":
        return f"start the shot that comes next at another time, or put `home` elsewhere; then {REPLAN}"
    return f"put `home` elsewhere, or end the last shot elsewhere; then {REPLAN}"


def _in_space(claim: Claim, code: str) -> str:
    if code == "V057":
        more = measure(2.0 * claim.worst, claim.unit)
        return f"write {more} more for each length of its `size`; then plan again"
    lack, worst = measure(abs(claim.worst - claim.limit), claim.unit), enough(claim)
    if code == "V022" and claim.drones:
        return f"draw larger or move slower, or ask for {lack} less `separation`; then plan again"
    texts = {
        "V007": f"move the path or shrink the zone by {lack}",
        "V008": f"move the path or widen the zone by {lack}",
        "V009": f"fly {lack} higher, or lower `ground_clearance` to {worst}",
        "V010": f"keep {lack} more distance, or lower `target_clearance` to {worst}",
        "V052": f"keep {lack} more distance, or lower `obstacle_clearance` to {worst}",
        "V055": f"shorten the mission by {lack}, fly it calmer, or write what `power` there is",
        "V013": f"shorten the mission by {lack}, or raise `endurance` to {worst}",
    }
    return texts.get(code, "")
