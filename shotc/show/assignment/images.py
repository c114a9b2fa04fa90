"""Reads the images that effects of lights project."""

from __future__ import annotations

from shotc.diag.model import Diagnostic
from shotc.ir.effects import Image
from shotc.ir.mission import MissionIR
from shotc.kinds.files import FileFault
from shotc.show.assignment import faults
from shotc.show.goals.footage import ImageFrames, read_frames


def images_of(mission: MissionIR) -> dict[str, ImageFrames] | list[Diagnostic]:
    """Return the frames of every image by name, or the faults of those that cannot be read."""
    files = dict(mission.files)
    frames_of: dict[str, ImageFrames] = {}
    wrong: dict[str, Diagnostic] = {}
    lights = max((len(fleet.pads) for fleet in mission.fleets), default=0)
    for effect in (effect for display in mission.displays for effect in display.every_effect):
        if not isinstance(effect.paint, Image) or effect.paint.file in {*frames_of, *wrong}:
            continue
        name = effect.paint.file
        frames = read_frames(files[name], lights)
        if isinstance(frames, FileFault):
            wrong[name] = faults.bad_image(mission, effect, name, frames)
        else:
            frames_of[name] = frames
    return list(wrong.values()) or frames_of
