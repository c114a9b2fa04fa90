"""Proposals for unknown words: the nearest known word, or the one for a synonym from elsewhere."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from difflib import get_close_matches

_LONGEST_WORD_CHARACTERS = 80
_SHORTEST_PART_CHARACTERS = 3  # letters; shorter words are parts of too many others
# Synonyms from elsewhere for keys, kinds and names that are not similar in spelling. Of several meanings the
# first that is known at the place is used.
_MEANT = {
    "alt": "height",
    "altitude": "height",
    "ele": "height",
    "elevation": "pitch",
    "tilt": "pitch",
    "yaw": "heading",
    "pan": "heading",
    "position": "at",
    "pos": "at",
    "location": "at",
    "name": "id",
    "type": "kind",
    "subject": "target",
    "circle": "torus orbit",
    "ring": "torus",
    "ball": "sphere",
    "box": "cube",
    "mesh": "model",
    "outline": "svg",
    "angle": "sweep",
    "wide": "long",
    "american": "medium-full",
    "cowboy": "medium-full",
    "around": "orbit",
    "arc": "orbit",
    "helix": "spiral",
    "pedestal": "elevator",
    "ascend": "elevator",
    "boom": "crane",
    "jib": "crane",
    "truck": "lateral",
    "follow": "chase",
    "tracking": "chase",
    "vertigo": "dolly-zoom",
    "overhead": "top-down",
    "hover": "static",
    "waypoints": "keyframes",
    "route": "follow-path",
    "show": "display",
}
# Keys that people expect in a place where the language does not have them.
_ELSEWHERE = {
    "hfov": "the field of view is the `camera`'s of a drone, or one of `kind: keyframes` at each of them",
    "speed": "how fast is a matter of `pace`, of `timing: {duration: ...}`, or of the drone's `limits`",
    "gimbal": "the gimbal is the drone's",
    "aperture": "the aperture is the `camera`'s of a drone",
    "shutter": "the shutter is the `camera`'s of a drone",
    "camera": "the camera is the drone's",
}


def closest(word: str, known: Iterable[str]) -> str | None:
    """Return the known word that ``word`` is most likely meant to be, if there is one."""
    if len(word) > _LONGEST_WORD_CHARACTERS:
        return None
    words = list(known)
    if slip := get_close_matches(word, words, n=1, cutoff=0.9):
        return slip[0]
    if meant := next((each for each in _MEANT.get(word, "").split() if each in words), None):
        return meant
    if part := _in_full(word, words):
        return part
    close = get_close_matches(word, words, n=1, cutoff=0.6)
    return close[0] if close else next((w for w in words if _alike(word.lower(), w.lower())), None)


def _in_full(word: str, words: Collection[str]) -> str | None:
    """Return the known name that equals a word but for case, starts with it, or is the longest one in it."""
    plain = "-".join(word.lower().replace("_", " ").split())
    names = [name for name in words if "-" in name]
    if plain in words:
        return plain
    begun = [name for name in names if name.startswith(f"{plain}-")]
    if len(begun) == 1:
        return begun[0]
    return max((name for name in names if name in plain), key=len, default=None)


def nearest(word: str, known: Iterable[str]) -> str:
    """Return a help that proposes the nearest known word, or lists them all."""
    words = list(known)
    close = closest(word, words)
    if close:
        return f"did you mean `{close}`?"
    return f"known are {', '.join(words)}" if len(words) > 1 else f"the only one known is `{words[0]}`"


def elsewhere(key: str, known: Collection[str]) -> str:
    """Return the place of a key that people expect among the known ones, in words; empty for any other
    key.
    """
    return "" if key in known else _ELSEWHERE.get(key, "")


def each(names: Iterable[str]) -> str:
    """Return names in backticks as text, the last one after `and`."""
    words = [f"`{name}`" for name in names]
    return " and ".join(filter(None, (", ".join(words[:-1]), *words[-1:])))


def _alike(word: str, other: str) -> bool:
    """Return whether two words are equal but for case, or one is a part of the other."""
    short, long = sorted((word, other), key=len)
    return short == long or (len(short) >= _SHORTEST_PART_CHARACTERS and short in long)
