"""Where a display's words stand in the mission, and what to write there instead, for diagnostics."""

from __future__ import annotations

from math import pi, sin

from shotc.diag.model import Label
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.show import Box, Drawing, Fleet, Lettering, Model, Picture, RecordedFlight, Sphere, Torus
from shotc.rounding import at_least

KEYS = {
    Sphere: "sphere",
    Box: "cube",
    Torus: "torus",
    Lettering: "text",
    Drawing: "svg",
    Model: "model",
    RecordedFlight: "flight",
}


def key_of(picture: Picture) -> KeyPath:
    """Return the path of what a picture shows; a display may give the files of one animation alone."""
    alone = picture.path[-1] == "frames"
    return picture.path if alone else (*picture.path, word_of(picture))


def word_of(picture: Picture) -> str:
    """Return the word by which the mission says what a picture shows."""
    return KEYS[type(picture.source)]


def transition_label(mission: MissionIR, picture: Picture) -> Label:
    """Return a label on how long the way to a picture takes, or on what says how it is gone."""
    path = (*picture.path, "transition")
    longer = (*path, "duration")
    return mission.origins.value(longer if longer in mission.origins.values else path)


def transition_key(mission: MissionIR, picture: Picture) -> str:
    """Return the key under which the mission says how long the way to a picture takes."""
    longer = (*picture.path, "transition", "duration")
    return "duration" if longer in mission.origins.values else "transition"


def wave_key(mission: MissionIR, picture: Picture) -> KeyPath:
    """Return the path of what says how long the wave to a picture lasts."""
    path = (*picture.path, "transition", "wave")
    longer = (*path, "time")
    return longer if longer in mission.origins.values else path


def moments(mission: MissionIR, earliest: float) -> str:
    """Say when a picture may stand at the earliest, in seconds and in beats."""
    possible, music = at_least(earliest), mission.music
    beat = None if music is None else music.next_beat(earliest)
    if music is None or beat is None:
        return f"write `at: {possible} s` or later"
    bar, part = divmod(beat - 1, music.per_bar)
    return f"write `at: {{beat: {beat}}}` (bar {bar + 1}, beat {part + 1}), `at: {possible} s` or later"


def centre_label(mission: MissionIR, picture: Picture, text: str = "") -> Label:
    """Return a label on the centre of a picture."""
    return mission.origins.value((*key_of(picture), "center"), text)


def wider(mission: MissionIR, fleet: Fleet, least: float) -> str:
    """Say how the layout has its pads so far apart, metres."""
    path = (*fleet.path, "layout")
    if (*path, "grid") in mission.origins.keys:
        return f"give the grid a spacing of {at_least(least)} m or more"
    if (*path, "circle") in mission.origins.keys:
        radius = least / (2 * sin(pi / len(fleet.pads)))
        return f"give the circle a radius of {at_least(radius)} m or more"
    return f"put the pads {at_least(least)} m or more apart"


def pads_path(mission: MissionIR, fleet: Fleet) -> KeyPath:
    """Return where the mission says where the pads of a fleet are: a place, a file, or else the layout."""
    path = (*fleet.path, "layout")
    ways = (("grid", "origin"), ("circle", "center"), ("file",))
    written = ((*path, *way) for way in ways if (*path, *way) in mission.origins.values)
    return next(written, path)
