"""Keyframes: the camera poses by the user, in order."""

from math import degrees
from typing import Literal

from pydantic import Field

from shotc.diag.model import Diagnostic
from shotc.ir.drone import LensRange
from shotc.ir.mission import Deferred
from shotc.kinds.base import Expansion, Kind, Part, Scene, Stand
from shotc.rounding import rounded_outward
from shotc.spec.shot import KeyframeSpec, ShotBase


class KeyframesShot(ShotBase):
    """The parameters of a shot through keyframes."""

    kind: Literal["keyframes"] = Field(description="what sort of shot it is")
    keyframes: tuple[KeyframeSpec, ...] = Field(
        min_length=2, description="camera poses in order, two or more"
    )


def expand(shot: KeyframesShot, scene: Scene) -> Expansion:
    """Return the keyframes as they are written."""
    return Expansion.of(_keyframe(shot, scene, i) for i in range(len(shot.keyframes)))


def _keyframe(shot: KeyframesShot, scene: Scene, index: int) -> Part:
    spec, path = shot.keyframes[index], ("keyframes", index)
    aim = scene.aim(shot, spec, *path, own=spec.target)
    if isinstance(aim, Diagnostic | Deferred):
        return aim
    lens = scene.drone.lens
    if spec.hfov is not None and lens is not None and not lens.shows(spec.hfov):
        return _beyond_lens(scene, lens, spec.hfov, *path)
    stand = scene.stand(shot, spec.at, *path, "at")
    if not isinstance(stand, Stand):
        return stand
    return scene.keyframe(
        stand.at,
        aim[1],
        aim=aim[0],
        composition=spec.frame or scene.composition,
        hfov=spec.hfov or scene.drone.hfov,
        hold=spec.hold,
        time=spec.time,
        placed=True,
        path=(*scene.path, *path),
        heading=spec.heading,
        beside=stand.beside,
        box=spec.box,
    )


def _beyond_lens(scene: Scene, lens: LensRange, hfov: float, *path: str | int) -> Diagnostic:
    name, longest, widest = scene.drone.name, degrees(lens.longest), degrees(lens.widest)
    if not lens.zooms:
        message = f"the lens of `{name}` is fixed: it shows {widest:.4g} deg and not {degrees(hfov):.4g} deg"
        help_ = (
            "take `hfov` out and go nearer or farther; if the machine carries a lens that zooms, say which: "
            f"`camera: {{zoom: [24 mm, 70 mm]}}` of `{name}`"
        )
        return scene.fault("K018", message, help_, *path, "hfov")
    message = (
        f"the zoom of `{name}` goes from {longest:.4g} to {widest:.4g} deg, not to {degrees(hfov):.4g} deg"
    )
    nearest = lens.longest if hfov < lens.longest else lens.widest
    inside = rounded_outward(degrees(nearest), upper=hfov < lens.longest, digits=2)
    return scene.fault(
        "K018", message, f"write `hfov: {inside:g} deg`, and go nearer or farther", *path, "hfov"
    )


KIND = Kind("keyframes", "fly through camera poses of your own", KeyframesShot, expand)
