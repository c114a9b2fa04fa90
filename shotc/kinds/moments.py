"""Times of a show from seconds, beats or bars in a mission."""

from shotc.diag.model import Diagnostic
from shotc.ir.music import beat_of_bar
from shotc.ir.origin import KeyPath
from shotc.kinds.base import Scene
from shotc.spec.music import MomentSpec


def moment(spec: MomentSpec, scene: Scene, path: KeyPath) -> float | Diagnostic | None:
    """Return the mission time of a moment, seconds; a diagnostic for an invalid one, None for unusable beats.

    path : of the moment in the mission
    """
    return spec.time if spec.time is not None else on_beat(spec.beat, spec.bar, scene, path)


def on_beat(beat: float | None, bar: float | None, scene: Scene, path: KeyPath) -> float | Diagnostic | None:
    """Return the mission time of a beat, as ``moment``; with a bar, the beat is counted in that bar."""
    music = scene.music
    if music is not None and music.unread:
        return None
    per_bar = 4 if music is None else music.per_bar
    if bar is None:
        assert beat is not None
        key = "beat"
    else:
        beat, key = beat_of_bar(bar, beat or 1.0, per_bar), "bar"
    label = scene.origins.value((*path, key))
    if music is None or not music.has_beats:
        note = "the mission has no `music`" if music is None else "its `music` says nothing of beats"
        help_ = "write `music: {tempo: 120}`, `beats` or `beats_file`, or give the moment in seconds"
        return Diagnostic("D121", f"nothing says when this {key} falls", (label,), (note,), help_)
    time = music.time(beat)
    if time is not None:
        return time
    last = len(music.listed)
    bars = (last - 1) // per_bar + 1
    return Diagnostic(
        "D122",
        f"the music has no beat {beat:g}: it ends with beat {last}",
        (label, scene.origins.key(music.path, "the music")),
        (f"beat {last} is in bar {bars}, with {per_bar} beats in a bar",),
        f"write `at: {{beat: {last}}}` or an earlier one, list more beats, or give the moment in seconds",
    )
