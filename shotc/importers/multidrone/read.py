"""Read the elements of a MultiDrone mission. Decimal commas and gaps are repaired and noted."""

from __future__ import annotations

import json
import re
from typing import Any, NamedTuple

from shotc.importers.notes import Notes, plain
from shotc.importers.xml_tree import Node

LARGEST_VALUE = 5e4  # metres or seconds, larger values are damage
SHORTEST_S = (
    1.0  # seconds, the MultiDrone planner rounds durations down to whole seconds, and 0 is no duration
)
KMH_PER_M_S = 3.6  # the dashboard writes `formationSpeed` in km/h
PARAMS = frozenset(("x_s", "x_e", "y_0", "z_0", "z_s", "z_e", "r_0", "azimuth_s", "azimuth_speed"))
PARAMS |= frozenset(("pan_s", "pan_e", "tilt_s", "tilt_e", "ID"))
FLIES = frozenset(("FLY_THROUGH", "FLY THROUGH", "FLYTHROUGH"))
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_COMMA = re.compile(r"[+-]?\d+,\d+", re.ASCII)


class MissionPoint(NamedTuple):
    """A place: (x, y) in m, or (lat, lon) in deg if ``on_earth``; altitude and time, None if missing."""

    node: Node
    at: tuple[float, float]
    on_earth: bool
    z: float | None
    time: float | None


class Role(NamedTuple):
    """The role of one drone in an action: the kind of shot, and its parameters.

    given : the element of the parameters, or the element of the role if it has none
    """

    node: Node
    given: Node
    kind: str
    framing: str
    composition: str
    params: dict[str, float]


class ShootingAction(NamedTuple):
    """One shooting action: its target's trajectory, the formation's origin, and the roles of the drones.

    speed : speed of the formation, m/s, or None
    """

    node: Node
    duration: float
    speed: float | None
    points: tuple[MissionPoint, ...]
    origin: MissionPoint | None
    roles: tuple[Role, ...]

    @property
    def places(self) -> tuple[MissionPoint, ...]:
        """Its points and the origin of the formation."""
        return self.points if self.origin is None else (*self.points, self.origin)

    @property
    def flies(self) -> bool:
        """Whether it is a fly-through: its trajectory is that of its cameras, and it follows no target."""
        return all(role.kind in FLIES for role in self.roles)


class Sequence(NamedTuple):
    """Actions that one formation films in order. ``main``: whether it has priority over others."""

    node: Node
    name: str
    main: bool
    actions: tuple[ShootingAction, ...]


def sequences_of(root: Node, notes: Notes) -> tuple[Sequence, ...]:
    """Return all shooting action sequences that have something to film."""
    sequences = []
    for node in below(root, "shootingActionSequence"):
        actions = [_action(child, notes) for child in below(node, "shootingAction")]
        known = tuple(action for action in actions if action is not None)
        if known:
            sequences.append(Sequence(node, node.value("name"), node.value("role") != "secondary", known))
        else:
            notes.assume(
                node, "a sequence without a shooting action that can be read", "the sequence is left out"
            )
    return tuple(sequences)


def below(node: Node, tag: str) -> list[Node]:
    """Return the elements with that name at any depth, in order. The reader has limited the tree's depth."""
    nodes = []
    for child in node.children:
        nodes += [child] if child.tag == tag else below(child, tag)
    return nodes


def number(node: Node | None, notes: Notes) -> float | None:
    """Return the number in an element, None if it has none. A decimal comma is accepted and noted."""
    if node is None or not node.text.strip():
        return None
    return _number(node.text.strip(), "", node, notes)


def _number(text: str, name: str, node: Node, notes: Notes) -> float | None:
    """Return the number in a text of an element, or None. ``name``: name of the parameter, or empty."""
    quoted = f"{name} = `{text[:30]}`" if name else f"`{text[:30]}`"
    if _COMMA.fullmatch(text):
        corrected = text.replace(",", ".")
        notes.assume(node, f"{quoted} has a decimal comma", corrected)
        text = corrected
    if _NUMBER.fullmatch(text) and abs(value := float(text)) <= LARGEST_VALUE:
        return value
    notes.assume(node, f"{quoted} is no number that can be meant", "it counts as missing")
    return None


def _action(node: Node, notes: Notes) -> ShootingAction | None:
    kind = node.attributes.get("shootingActionTemplateRef", "")
    points = [_point(p, notes) for p in below(node, "RTTrajectoryPoint")]
    origin = node.first("originOfFormation")
    roles = [_role(r, kind, notes) for r in below(node, "shootingRole")]
    if not roles:
        if not kind:
            notes.assume(node, "an action that neither names its shot nor has a role", "it is left out")
            return None
        taken = f"one {plain(kind, 30)} with its usual parameters"
        notes.assume(node, "an action without a shooting role", taken)
        roles = [Role(node, node, kind.upper(), "", "", {})]
    duration = number(node.first("duration"), notes)
    if duration is None or duration < SHORTEST_S:
        duration = 20.0
        message = "an action without a duration lasts to the next event, which the file does not give"
        notes.assume(node.first("duration") or node, message, "20 s")
    speed = number(node.first("formationSpeed"), notes)
    return ShootingAction(
        node,
        duration,
        None if speed is None or speed < 0 else speed / KMH_PER_M_S,
        tuple(p for p in points if p is not None),
        None if origin is None else _point(origin, notes),
        tuple(roles),
    )


def _point(node: Node, notes: Notes) -> MissionPoint | None:
    names = (("x", "y"), ("latitude", "longitude"), ("lat", "lon"))
    for first, second in names:
        a, b = number(node.first(first), notes), number(node.first(second), notes)
        if a is None and b is None:
            continue
        on_earth = first != "x"
        if a is None or b is None or (on_earth and (abs(a) > 90 or abs(b) > 180)):
            notes.assume(node, f"a point whose {first} and {second} are no place", "the point is left out")
            return None
        z, time = number(node.first("altitude"), notes), number(node.first("time"), notes)
        return MissionPoint(node, (a, b), on_earth, z, time)
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
            read = _parameter(name, given, written, notes) if name in PARAMS else None
            if read is not None:
                params[name] = read
    name = node.value("name") or kind
    given_in = node.first("params") or node
    return Role(
        node, given_in, name.upper(), node.value("framingTypeName"), node.value("shootingTypeName"), params
    )


def _parameter(name: str, value: Any, node: Node, notes: Notes) -> float | None:
    if isinstance(value, str) and value.strip():
        return _number(value.strip(), name, node, notes)
    if isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= LARGEST_VALUE:
        return float(value)
    text = plain(str(value), 30)
    notes.assume(node, f"{name} = `{text}` is no number that can be meant", "it counts as missing")
    return None
