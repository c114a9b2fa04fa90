"""Dolly zoom: the camera moves towards the target or away, and zooms so that the target keeps its size.

The background seems to shrink or to grow. At every keyframe the field of view gives the target's outline the
same height in the frame as at the first one.
"""

from math import ceil, degrees, floor, isfinite
from typing import Literal

from pydantic import Field

from shotc.diag.model import Diagnostic
from shotc.geom.focal import focal_length
from shotc.geom.vec import Vec3, minus
from shotc.geom.viewpoint import Lens, RequiredView, lens_for, size_from
from shotc.ir.target import Target
from shotc.kinds.base import Expansion, Kind, Scene
from shotc.kinds.rounds import axis_of, line
from shotc.spec.fields import Angle, CameraAltitude, FieldOfView, Name, PositiveLengthSpan
from shotc.spec.shot import ShotBase

LEAST_PIECES = 24
"""Least number of pieces of the path; for a threefold change of distance the size error is below 0.1 %."""
LEAST_WAY_M = 1e-3


class DollyZoomShot(ShotBase):
    """The parameters of a dolly zoom."""

    kind: Literal["dolly-zoom"] = Field(description="what sort of shot it is")
    target: Name = Field(description="name of the target whose size is held")
    azimuth: Angle = Field(description="compass bearing from the target to the camera")
    distance: PositiveLengthSpan = Field(description="horizontal distance from the target's axis, [from, to]")
    altitude: CameraAltitude = Field(description="height of the camera over the target's foot")
    hfov: FieldOfView | None = Field(
        default=None, description="field of view at the beginning; the camera's own by default"
    )


def expand(shot: DollyZoomShot, scene: Scene) -> Expansion:
    """Return keyframes along the line, each with the field of view that keeps the target's size."""
    target = scene.subject(shot.target, "target")
    if not isinstance(target, Target):
        return Expansion.of([target])
    if target.track is not None:
        message = f"the size of `{target.name}` cannot be held by a zoom: it moves"
        help_ = "film it as a framing with a size, which is held by the distance"
        return Expansion.of([scene.fault("K019", message, help_, "target")])
    if abs(shot.distance[1] - shot.distance[0]) < LEAST_WAY_M:
        help_ = "give `distance` as [from, to]"
        return Expansion.of([scene.fault("K010", "nothing moves in this dolly-zoom", help_, "distance")])
    above, span = shot.altitude.above, shot.altitude.span
    looked_at = scene.height_of(target, above)
    points = line(axis_of(target), shot.azimuth, shot.distance, span, looked_at, LEAST_PIECES)
    eyes = [scene.raised(point, target, above) for point in points]
    lenses = _lenses(shot, scene, target, eyes)
    if isinstance(lenses, Diagnostic):
        return Expansion.of([lenses])
    return Expansion.of(
        scene.keyframe(eye, target.name, hfov=hfov) for eye, hfov in zip(eyes, lenses, strict=True)
    )


def _lenses(
    shot: DollyZoomShot, scene: Scene, target: Target, eyes: list[Vec3]
) -> tuple[float, ...] | Diagnostic:
    """Return the fields of view at the keyframes, rad, or the fault if the lens does not have them."""
    drone, places = scene.drone, scene.composition.points
    first = Lens(shot.hfov or drone.hfov, drone.aspect, drone.gimbal.pitch)
    subject = RequiredView(target.centre, target.shape, places[0] if len(places) == 1 else None)
    offsets = [minus(eye, target.centre) for eye in eyes]
    size = size_from(subject, first, offsets[0])
    if not isfinite(size):
        message = f"`{target.name}` is not in front of the camera where this shot begins"
        return scene.fault("K018", message, "begin farther away from it", "distance")
    hfovs = [lens_for(subject, first, offset, size) for offset in offsets]
    lenses = tuple(hfov for hfov in hfovs if hfov is not None)
    if len(lenses) < len(hfovs):
        message = f"no lens shows `{target.name}` from so near in the size that it has at first"
        help_ = "end farther away, or begin with a wider `hfov` or farther away"
        return scene.fault("K018", message, help_, "distance")
    if drone.lens is None or all(drone.lens.shows(hfov) for hfov in lenses):
        return lenses
    low, high = degrees(min(lenses)), degrees(max(lenses))
    has = f"{degrees(drone.lens.longest):.4g} to {degrees(drone.lens.widest):.4g} deg"
    short, long = floor(1e3 * focal_length(max(lenses))), ceil(1e3 * focal_length(min(lenses)))
    message = f"this dolly-zoom takes {low:.4g} to {high:.4g} deg, and the lens of `{drone.name}` has {has}"
    help_ = (
        "shorten `distance`, begin with another `hfov`, or carry a lens that has it: "
        f"`camera: {{zoom: [{short} mm, {long} mm]}}` of `{drone.name}`, on a frame 36 mm wide"
    )
    return scene.fault("K018", message, help_, "distance")


KIND = Kind("dolly-zoom", "move towards the target or away and zoom: its size is held", DollyZoomShot, expand)
