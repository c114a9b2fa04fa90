"""The elements of a MultiDrone mission as numbers and names: decimal commas and gaps mended, and noted."""

from __future__ import annotations

import json
import re
from math import isfinite
from typing import NamedTuple

from shotc.importers.notes import Notes
from shotc.importers.xml_tree import Node

LARGEST = 1e6  # metres or seconds; what is beyond is damage


class Point(NamedTuple):
    """A place of a trajectory: (x, y) in metres, or (lat, lon) where ``on_earth``; time or None."""

    node: Node
    at: tuple[float, float]
    on_earth: bool
    time: float | None


class Role(NamedTuple):
    """What one drone does in an action: the kind of shot, and its parameters."""

    node: Node
    kind: str
    framing: str
    composition: str
    params: dict[str, float]


class Action(NamedTuple):
    """One shooting action: its target's way, where the formation starts, and who films how."""

    node: Node
    name: str
    duration: float
    speed: float
    points: tuple[Point, ...]
    origin: Point | None
    roles: tuple[Role, ...]


class Sequence(NamedTuple):
    """Actions that one formation films one after the other."""

    node: Node
    name: str
    actions: tuple[Action, ...]


def sequences_of(root: Node, notes: Notes) -> tuple[Sequence, ...]:
    """Return all shooting action sequences that hold something to film."""
    found = []
    for node in _below(root, "shootingActionSequence"):
        actions = [_action(child, notes) for child in _below(node, "shootingAction")]
        kept = tuple(action for action in actions if action is not None)
        if kept:
            found.append(Sequence(node, node.value("name"), kept))
        else:
            notes.assume(
                node, "a sequence without a shooting action that can be read", "the sequence is left out"
            )
    return tuple(found)


def number(node: Node | None, notes: Notes) -> float | None:
    """Return the number in an element, None where there is none; a decimal comma is read, and noted."""
    if node is None or not node.text.strip():
        return None
    text = node.text.strip()
    if re.fullmatch(r"[+-]?\d+,\d+", text):
        mended = text.replace(",", ".")
        notes.assume(node, f"`{text}` has a decimal comma", mended)
        text = mended
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if isfinite(value) and abs(value) <= LARGEST:
        return value
    notes.assume(node, f"`{text[:30]}` is no number that can be meant", "it counts as missing")
    return None


def _below(node: Node, tag: str) -> list[Node]:
    """Return the elements of that name at any depth, in order; the tree is no deeper than it may be."""
    found = []
    for child in node.children:
        found += [child] if child.tag == tag else _below(child, tag)
    return found


def _action(node: Node, notes: Notes) -> Action | None:
    kind = node.attributes.get("shootingActionTemplateRef", "")
    points = [_point(p, notes) for p in _below(node, "RTTrajectoryPoint")]
    origin = node.first("originOfFormation")
    roles = [_role(r, kind, notes) for r in _below(node, "shootingRole")]
    if not roles:
        if not kind:
            notes.assume(node, "an action that neither names its shot nor has a role", "it is left out")
            return None
        notes.assume(node, "an action without a shooting role", f"one {kind} with its usual parameters")
        roles = [Role(node, kind, "", "", {})]
    duration = number(node.first("duration"), notes)
    if duration is None or duration <= 0:
        duration = 20.0
        notes.assume(node.first("duration") or node, "an action without a duration", "20 s")
    speed = number(node.first("formationSpeed"), notes)
    if speed is None or speed < 0:
        speed = 1.0
        notes.assume(node.first("formationSpeed") or node, "an action without a formation speed", "1 m/s")
    return Action(
        node,
        node.value("name"),
        duration,
        speed,
        tuple(p for p in points if p is not None),
        None if origin is None else _point(origin, notes),
        tuple(roles),
    )


def _point(node: Node, notes: Notes) -> Point | None:
    names = (("x", "y"), ("latitude", "longitude"), ("lat", "lon"))
    for first, second in names:
        a, b = number(node.first(first), notes), number(node.first(second), notes)
        if a is None and b is None:
            continue
        on_earth = first != "x"
        if a is None or b is None or (on_earth and (abs(a) > 90 or abs(b) > 180)):
            notes.assume(node, f"a point whose {first} and {second} are no place", "the point is left out")
            return None
        return Point(node, (a, b), on_earth, number(node.first("time"), notes))
    notes.assume(node, "a point without a place", "the point is left out")
    return None


def _role(node: Node, kind: str, notes: Notes) -> Role:
    params: dict[str, float] = {}
    for tag in ("targetIdentifierParams", "params"):
        written = node.first(tag)
        if written is None or not written.text.strip():
            continue
        try:
            table = json.loads(written.text)
        except (ValueError, RecursionError):
            notes.assume(written, "parameters that are no JSON", "they count as missing")
            continue
        for name, value in table.items() if isinstance(table, dict) else ():
            given = value.get("value") if isinstance(value, dict) else value
            if isinstance(given, int | float) and not isinstance(given, bool) and abs(given) <= LARGEST:
                params[str(name)] = float(given)
    name = node.value("name") or kind
    return Role(node, name.upper(), node.value("framingTypeName"), node.value("shootingTypeName"), params)
