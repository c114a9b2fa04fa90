"""Source locations of a display's keys, and proposed values, for diagnostics."""

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
    """Return the path of a picture's source; the frames of an animation may stand directly in a display."""
    alone = picture.path[-1] == "frames"
    return picture.path if alone else (*picture.path, word_of(picture))


def word_of(picture: Picture) -> str:
    """Return the mission's key for the kind of a picture's source."""
    return KEYS[type(picture.source)]


def transition_label(mission: MissionIR, picture: Picture) -> Label:
    """Return a label on the duration of the move to a picture, or on its transition if no duration is
    written.
    """
    path = (*picture.path, "transition")
    longer = (*path, "duration")
    return mission.origins.value(longer if longer in mission.origins.values else path)


def transition_key(mission: MissionIR, picture: Picture) -> str:
    """Return the key that sets the duration of the move to a picture."""
    longer = (*picture.path, "transition", "duration")
    return "duration" if longer in mission.origins.values else "transition"


def wave_key(mission: MissionIR, picture: Picture) -> KeyPath:
    """Return the path of the key that sets the duration of the wave to a picture."""
    path = (*picture.path, "transition", "wave")
    longer = (*path, "time")
    return longer if longer in mission.origins.values else path


def moments(mission: MissionIR, earliest: float) -> str:
    """Describe the earliest possible time of a picture, in seconds and in beats."""
    possible, music = at_least(earliest), mission.music
    beat = None if music is None else music.next_beat(earliest)
    if music is None or beat is None:
        return f"write `at: {possible} s` or later"
    bar, part = divmod(beat - 1, music.per_bar)
    return f"write `at: {{beat: {beat}}}` (bar {bar + 1}, beat {part + 1}), `at: {possible} s` or later"


def centre_label(mission: MissionIR, picture: Picture) -> Label:
    """Return a label on the centre of a picture."""
    return mission.origins.value((*key_of(picture), "center"))


def wider(mission: MissionIR, fleet: Fleet, least: float) -> str:
    """Describe how to change the layout so that its pads are ``least`` metres apart."""
    path = (*fleet.path, "layout")
    if (*path, "grid") in mission.origins.keys:
        return f"give the grid a spacing of {at_least(least)} m or more"
    if (*path, "circle") in mission.origins.keys:
        radius = least / (2 * sin(pi / len(fleet.pads)))
        return f"give the circle a radius of {at_least(radius)} m or more"
    return f"put the pads {at_least(least)} m or more apart"


def pads_path(mission: MissionIR, fleet: Fleet) -> KeyPath:
    """Return where the mission places the pads of a fleet: the path of an origin, a file, or else
    the layout.
    """
    path = (*fleet.path, "layout")
    keys = (("grid", "origin"), ("circle", "center"), ("file",))
    written = ((*path, *key) for key in keys if (*path, *key) in mission.origins.values)
    return next(written, path)
