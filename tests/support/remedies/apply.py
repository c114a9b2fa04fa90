"""A help line taken at its word: each remedy that it names, written into the mission by a few general rules.

Nothing here knows a code. A remedy is understood by its form: ``key: value`` in backticks is set where the
language knows the key, near to what the diagnostic points at; `did you mean` writes the word over the one
that is marked; a bare number with "or more", "later than" or the like replaces the marked value.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from copy import deepcopy
from itertools import pairwise
from math import hypot
from typing import Any, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.source.file import KeyPath
from shotc.source.yaml_tree import Document, parse

STRICT = 1e-3
"""What is added to a number that a value has to be above of, in its unit."""
NUMBER = r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?"
UNIT = r"(?: (?:m/s\^2|m/s\^3|m/s|deg/s\^2|deg/s|deg|min|m|s|%)(?![\w/]))?"
QUANTITY = rf"{NUMBER}{UNIT}"
TICKED = re.compile(r"`([a-z_]+(?:\.[a-z_]+)*: [^`]+)`")
AGAINST = {"look_at": ("heading", "pitch"), "heading": ("look_at",)}
"""Keys that are written instead of others: they cannot stand beside each other."""
MISSING = object()
SECTIONS = ("drones", "targets", "fleets", "shots", "world.zones")


class Remedy(NamedTuple):
    """One alternative of a help line and the missions that it may mean, likeliest first."""

    text: str
    missions: tuple[str, ...]


class Place(NamedTuple):
    """Where a label points: a key path, and whether it marks the key instead of the value."""

    path: KeyPath
    on_key: bool


class Scene(NamedTuple):
    """A mission as plain values, and where the diagnostic points, the primary label first.

    word : what the message quotes first
    """

    root: dict[str, Any]
    places: tuple[Place, ...]
    word: str = ""


def remedies(text: str, diagnostic: Diagnostic) -> Iterator[Remedy]:
    """Yield each alternative of the help that can be applied by rule, with the missions it may mean."""
    document = parse(text.encode(), "mission.yaml")
    if not isinstance(document.root, dict):
        return
    quoted = re.search(r"`([^`]+)`", diagnostic.message)
    scene = Scene(document.root, tuple(_places(document, diagnostic)), quoted[1] if quoted else "")
    for alternative in alternatives(diagnostic.help):
        made: dict[str, None] = {}
        for rule in RULES:
            for root in rule(alternative, scene):
                made[json.dumps(root, indent=1, ensure_ascii=False)] = None
            if made:
                break
        if made:
            yield Remedy(alternative, tuple(made))


def alternatives(help_: str) -> list[str]:
    """Split a help line where another way out begins."""
    parts = re.split(
        r"(?:, or |; (?=to |if )| or (?=`|widen|write|raise|lower|leave|remove|move|give|keep))", help_
    )
    return [part for part in parts if part.strip()]


def _places(document: Document, diagnostic: Diagnostic) -> Iterator[Place]:
    for label in diagnostic.labels:
        values = [path for path, span in document.values.items() if span == label.span]
        keys = [path for path, span in document.keys.items() if span == label.span]
        if values or keys:
            yield Place((values or keys)[0], not values)
        else:  # a place within a value or a whole line: what stands nearest round it
            within = [
                path
                for path, span in document.values.items()
                if (span.line, span.column) <= (label.span.line, label.span.column)
                and (label.span.end_line, label.span.end_column) <= (span.end_line, span.end_column)
            ]
            yield Place(max(within, key=len, default=()), False)


def value(text: str) -> Any:
    """Return what a text says as a YAML value."""
    return parse(f"value: {text}".encode(), "value").root["value"]


def at(root: Any, path: KeyPath) -> Any:
    for key in path:
        try:
            root = root[key]
        except (KeyError, IndexError, TypeError):
            return MISSING
    return root


def put(root: dict[str, Any], path: KeyPath, new: Any) -> dict[str, Any]:
    """Return a copy with a value at a path; mappings are merged."""
    made = deepcopy(root)
    if not path:
        return merged(made, new)
    inner = made
    for key, after in pairwise(path):
        if isinstance(inner, dict) and not isinstance(inner.get(key), dict | list):
            inner[key] = {} if isinstance(after, str) else []
        inner = inner[key]
    old = inner[path[-1]] if isinstance(inner, list) else inner.get(path[-1])
    inner[path[-1]] = merged(old, new) if isinstance(old, dict) and isinstance(new, dict) else new
    return made


def merged(old: dict[str, Any], new: dict[str, Any]) -> dict[str, Any]:
    for key, what in new.items():
        inner = old.get(key)
        both = isinstance(inner, dict) and isinstance(what, dict)
        old[key] = merged(inner, what) if both else what
    return old


def without(root: dict[str, Any], path: KeyPath) -> dict[str, Any]:
    made = deepcopy(root)
    inner = at(made, path[:-1])
    if isinstance(inner, list):
        inner[path[-1]] = {}
    else:
        del inner[path[-1]]
    return made


def around(scene: Scene, text: str) -> Iterator[KeyPath]:
    """Yield the mappings in which a key may be meant: what is named, then what is marked, inside out."""
    done = set()
    shots: list[KeyPath] = []
    flies: list[KeyPath] = []
    for place in scene.places:
        if place.path[:1] == ("shots",) and len(place.path) > 1:
            shot = at(scene.root, place.path[:2])
            flies += [(f"{key}s", shot[key]) for key in ("drone", "fleet") if key in shot]
    if re.search(r"the shot\b", text):
        shots = [("shots", i) for i in range(len(scene.root.get("shots", ())))]
    for path in (*named(scene.root, text), *(place.path for place in scene.places), *flies, *shots):
        for length in range(len(path), -1, -1):
            if isinstance(at(scene.root, path[:length]), dict) and path[:length] not in done:
                done.add(path[:length])
                yield path[:length]


def named(root: dict[str, Any], text: str) -> Iterator[KeyPath]:
    """Yield the paths of drones, shots and the like whose names stand in backticks."""
    for name in re.findall(r"`([^`]*)`", text):
        for section in SECTIONS:
            path: KeyPath = tuple(section.split("."))
            held = at(root, path)
            if isinstance(held, dict) and name in held:
                yield (*path, name)
            elif isinstance(held, list):
                yield from ((*path, i) for i, item in enumerate(held) if item.get("id") == name)


def apart(text: str, scene: Scene) -> Iterator[dict[str, Any]]:
    """`key: value` here, and `key: value` for the shot, or and every `time` so many times as late."""
    here, _, rest = text.partition(", and ")
    times = re.search(rf"every `time` ({NUMBER}) times as late", rest)
    if times is None and "for the shot" not in rest:
        return
    for root in settings(here, scene):
        if times is None:
            yield from settings(rest, scene._replace(root=root))
            continue
        for shot in (made := deepcopy(root)).get("shots", ()):
            for keyframe in shot.get("keyframes", ()):
                if "time" in keyframe:
                    number, _, unit = str(keyframe["time"]).partition(" ")
                    keyframe["time"] = f"{float(number) * float(times[1])} {unit or 's'}"
        yield made


def settings(text: str, scene: Scene) -> Iterator[dict[str, Any]]:
    """`key: value` in backticks, one or several at once, set where the key is or else may be."""
    said = [
        value(f"{{{pairs}}}") for pairs in TICKED.findall(text) if "..." not in pairs and "NAME" not in pairs
    ]
    if not said:
        return
    new = {key: what for one in said for key, what in one.items()}
    if "what films it" in text:
        shots = [shot | new for shot in scene.root["shots"]]
        yield scene.root | {"shots": shots}
    if "of every subject" in text:
        shots = [
            shot | {"subjects": [subject | new for subject in shot.get("subjects", ())]}
            for shot in scene.root["shots"]
        ]
        yield scene.root | {"shots": shots}
    places = list(around(scene, text))
    first = [place for place in places if at(scene.root, (*place, next(iter(new)))) is not MISSING]
    replaced = re.findall(r"`([a-z_]+)`", text.partition(" in place of ")[2])
    for place in (*first, *(place for place in places if place not in first)):
        if replaced:
            held = {key: what for key, what in at(scene.root, place).items() if key not in replaced}
            yield put(without(scene.root, place) if place else {}, place, held | new)
            continue
        yield put(scene.root, place, new)
        if any(key in AGAINST for key in new):
            others = {other for key in new for other in AGAINST.get(key, ())} - set(new)
            held = {key: what for key, what in at(scene.root, place).items() if key not in others}
            yield put(without(scene.root, place) if place else {}, place, held | new)
        if place[:1] == ("shots",) and len(place) == 2 and set(new) <= {"duration", "start"}:
            timing = at(scene.root, (*place, "timing"))
            yield put(scene.root, (*place, "timing"), (timing if isinstance(timing, dict) else {}) | new)


def numbered_settings(text: str, scene: Scene) -> Iterator[dict[str, Any]]:
    """`limits.speed` to 9 m/s, the second value of `gimbal.pitch` to 31 deg, a `separation` of 0.5 m."""
    found = re.search(
        r"(?:(first|second) value of )?`([a-z_]+(?:\.[a-z_]+)*)` (?:of |to )"
        rf"(?:more than |at least |below )?({QUANTITY})",
        text,
    )
    if found is None:
        return
    which, key, what = found[1], tuple(found[2].split(".")), value(found[3])
    places = list(around(scene, text))
    first = [place for place in places if at(scene.root, (*place, *key)) is not MISSING]
    for place in (*first, *(place for place in places if place not in first)):
        if which is not None:
            pair = at(scene.root, (*place, *key))
            pair = list(pair) if isinstance(pair, list) else ["-90 deg", "30 deg"]
            pair[which == "second"] = what
            yield put(scene.root, (*place, *key), pair)
        else:
            yield put(scene.root, (*place, *key), what)


def meant(text: str, scene: Scene) -> Iterator[dict[str, Any]]:
    """Did you mean `word`; call it something else, such as `word`."""
    found = re.search(r"(?:did you mean|something else, such as) `([^`:]+)`", text)
    if found is None or not scene.places:
        return
    place = scene.places[0]
    old = at(scene.root, place.path)
    if not place.on_key and isinstance(old, str) and scene.word != old and scene.word in old:
        yield put(scene.root, place.path, old.replace(scene.word, found[1]))
        return
    if "did you mean" in text and place.on_key:
        made = without(scene.root, place.path)
        yield put(made, (*place.path[:-1], found[1]), at(scene.root, place.path))
    else:
        yield put(scene.root, place.path, value(found[1]))


def removals(text: str, scene: Scene) -> Iterator[dict[str, Any]]:
    """Remove `key`, leave `key` out, leave it out, drop one `key`."""
    if not re.search(r"\b(?:remove|leave|drop)\b", text):
        return
    found = re.search(r"(?:remove|leave|drop one) `([a-z_]+)(?:: [^`]*)?`", text)
    if found is None:
        if re.search(r"\b(?:remove|leave) it\b", text) and scene.places:
            yield without(scene.root, scene.places[0].path)
        return
    mappings = list(around(scene, text))
    views = [(*place, "view") for place in mappings if isinstance(at(scene.root, (*place, "view")), dict)]
    for place in (*mappings, *views, *(p.path[:-1] for p in scene.places)):
        if at(scene.root, (*place, found[1])) is not MISSING:
            less = scene._replace(root=without(scene.root, (*place, found[1])))
            rest = text.partition(" and ")[2]
            yield from settings(rest, less) if rest else (less.root,)


def positions(text: str, scene: Scene) -> Iterator[dict[str, Any]]:
    """Move it to [x, y, z]."""
    found = re.search(rf"\bto (\[{NUMBER}, {NUMBER}, {NUMBER}\])", text)
    if found is None or not scene.places:
        return
    path = scene.places[0].path
    if isinstance(at(scene.root, path), list):
        yield put(scene.root, path, value(found[1]))
    for place in around(scene, text):
        for key in ("at", "home"):
            if at(scene.root, (*place, key)) is not MISSING:
                yield put(scene.root, (*place, key), value(found[1]))


def heights(text: str, scene: Scene) -> Iterator[dict[str, Any]]:
    """Raise it to z = 2.60; put its middle at z = 12."""
    found = re.search(rf"z = ({NUMBER})", text)
    if found is None or not scene.places:
        return
    path, new = scene.places[0].path, value(found[1])
    old = at(scene.root, path)
    if isinstance(old, list):
        yield put(scene.root, path, [*old[:2], new])
    elif isinstance(old, dict):
        yield put(scene.root, (*path, "at"), [*old["at"][:2], new])
    else:
        yield put(scene.root, path, new)


def bounds(text: str, scene: Scene) -> Iterator[dict[str, Any]]:
    """Later than 15 s, 1.46 or less, a spacing of 2 m: the marked value becomes it."""
    forms = (
        (rf"(?:later|more) than ({QUANTITY})", STRICT),
        (rf"(?:below|less than) ({QUANTITY})", -STRICT),
        (rf"above ({QUANTITY})", STRICT),
        (rf"({QUANTITY}) or (?:more|less|later|higher|nearer)", 0.0),
        (rf"start it at ({QUANTITY})", 0.0),
        (rf"start it between {QUANTITY} and ({QUANTITY})", 0.0),
        (rf"(?:write|to|of) `?({QUANTITY})`?", 0.0),
        (rf"write (\[{NUMBER}[^\]]*\])", 0.0),
        (r"write `([^`:]+)`", 0.0),
        (rf"(?:use|take) ({NUMBER}) drones", 0.0),
    )
    if not scene.places or re.search(r"write an? [\w ]+ such as", text):
        return
    path = scene.places[0].path
    for form, more in forms:
        found = re.search(form, text)
        if found is None:
            continue
        new = value(found[1]) if not more else raised(found[1], more)
        for key in ("duration", "start", "count"):
            if re.search(rf"\b{key}|{'drones' if key == 'count' else key}\b", text) or (
                key == "duration" and "give it" in text
            ):
                for place in around(scene, text):
                    target = (
                        (*place, "timing", key)
                        if at(scene.root, (*place, "timing")) is not MISSING
                        else (*place, key)
                    )
                    if at(scene.root, target) is not MISSING:
                        yield put(scene.root, target, new)
        old = at(scene.root, path)
        if isinstance(old, list) and not isinstance(new, list):  # a velocity
            share = float(str(new).split()[0]) / hypot(*old)
            yield put(scene.root, path, [share * part for part in old])
        elif not isinstance(old, dict):
            yield put(scene.root, path, new)
        return


def raised(text: str, more: float) -> Any:
    number, _, unit = text.partition(" ")
    new = round(float(number) + more, 6)
    return f"{new} {unit}" if unit else new


Rule = Callable[[str, Scene], Iterator[dict[str, Any]]]
RULES: tuple[Rule, ...] = (removals, apart, settings, numbered_settings, meant, positions, heights, bounds)
