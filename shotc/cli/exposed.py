"""Facts about lenses, focus and shutter in the summary of a plan."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees, isfinite

from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import Claim, VerifiedIR
from shotc.passes.verify.sharpness import BACKGROUND, DISC, MOTION
from shotc.rounding import at_least, exposure


def exposed(plan: VerifiedIR) -> Iterator[tuple[str, str]]:
    """Yield (name, text) pairs: unknown lenses, worst sharpness and motion blur of subjects, and where."""
    yield from (("lens", text) for text in _unknown_lenses(plan.trajectory.keyframes.mission))
    for track in plan.trajectory.drones:
        drone = plan.trajectory.keyframes.mission.drone(track.drone)
        if drone.optics is None:
            continue
        claims = [c for c in plan.certificate if c.subject == drone.name]
        disc, motion, behind = (_worst(claims, end) for end in (DISC, MOTION, BACKGROUND))
        if disc is not None:
            yield "focus", f"{_lens(drone)}: {_discs(disc)}"
        if motion is not None and behind is not None and drone.optics.shutter is not None:
            moved = _value(motion, "px", 1, MOTION)
            past = _value(behind, "px", 1, BACKGROUND)
            yield (
                "shutter",
                f"{drone.name} at {exposure(drone.optics.shutter)}: in one exposure subjects move up to"
                f" {moved}, what is behind them up to {past}, of {drone.optics.pixels} px;"
                f" more than {motion.limit:.3g} px of a subject is warned of",
            )


def _lens(drone: Drone) -> str:
    assert drone.optics is not None
    taken = "" if drone.optics.sensor else " (taken for it, as no `sensor` is written)"
    return (
        f"{drone.name} at f/{drone.optics.aperture:g}, sensor {1e3 * drone.optics.width:.3g} mm wide{taken}"
    )


def _discs(claim: Claim) -> str:
    """Return the largest size of a point in the picture, and whether all subjects are sharp."""
    sharp = "all subjects sharp, " if claim.holds else ""
    largest = _value(claim, "mm", 3, DISC)
    return f"{sharp}points shown as discs of up to {largest}; {claim.limit:.3g} mm are sharp"


def _value(claim: Claim, unit: str, digits: int, ending: str) -> str:
    worst = f"{at_least(claim.worst, digits)} {unit}" if isfinite(claim.worst) else "any size"
    return f"{worst} ({claim.constraint.removesuffix(ending)}, shot {claim.shot})"


def _worst(claims: list[Claim], ending: str) -> Claim | None:
    return max((c for c in claims if c.constraint.endswith(ending)), key=lambda c: c.worst, default=None)


def _unknown_lenses(mission: MissionIR) -> list[str]:
    """Return a text for each drone that has to zoom, but whose mission does not give its camera a zoom."""
    texts = []
    for drone in mission.drones:
        shots = (shot for shot in mission.shots if shot.drone == drone.name)
        lenses = {drone.hfov, *(keyframe.hfov for shot in shots for keyframe in shot.keyframes)}
        if drone.lens is None and len(lenses) > 1:
            wish = (
                f"{drone.name} has to zoom from {degrees(min(lenses)):.4g} to {degrees(max(lenses)):.4g} deg"
            )
            texts.append(f"{wish}, and nothing says that its camera can: `camera: {{zoom: [24 mm, 70 mm]}}`")
    return texts
