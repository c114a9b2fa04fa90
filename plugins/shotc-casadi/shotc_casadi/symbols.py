"""One stage of the optimal-control problem in CasADi symbols: dynamics, cost and constraints.

State (16): position, velocity, acceleration (W, SI); camera yaw with rate and acceleration; camera pitch
likewise; time. Input (6): jerk; yaw and pitch jerk; the stage's length in seconds. A stage has a fixed
progress along the reference path, so its length sets how fast the progress is (theta of Gebhardt and Hilliges
Eq. 15, with progress as the independent variable). If the lens zooms, there are two more states (the
horizontal field of view and its rate) and one more input (its acceleration).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

import casadi as ca

from shotc_casadi.conditions import Visibility
from shotc_casadi.extents import EXTENT_PARAMETERS, Extent, rounded

STATES, INPUTS = 16, 6
POSITION, VELOCITY, ACCELERATION = slice(0, 3), slice(3, 6), slice(6, 9)
YAW, YAW_RATE, YAW_ACCELERATION, PITCH, PITCH_RATE, PITCH_ACCELERATION, TIME = range(9, 16)
JERK, YAW_JERK, PITCH_JERK, LENGTH = slice(0, 3), 3, 4, 5
LENS, LENS_RATE, LENS_ACCELERATION = 16, 17, 6  # states and input of a lens that zooms
LENS_STATES, LENS_INPUTS = 2, 1

WIND_PARAMETERS = 2  # parameters of the wind

RIGHT, UP, AHEAD = range(3)  # what _to_camera returns
EDGES = ((RIGHT, 1), (RIGHT, -1), (UP, 1), (UP, -1))  # left, right, bottom, top: axis, inward sign

FIELDS = {
    "centre": 3,
    "radius": 1,
    "height": 1,
    "place": 2,
    "half_width": 1,
    "half_height": 1,
    "inside": 4,
    "aim": 2,
    "state": STATES,
    "state_weight": STATES,
    "tangent": 3,
    "lag": 1,
    "framing": 1,
    "visibility": 1,
    "aiming": 1,
    "jerk": 1,
    "angular_jerk": 1,
    "time": 1,
    "pace": 1,
    "nominal": 1,
}
"""The parameters of a stage and their sizes.

Then follow: the target's bodies unless it is a cylinder, the half-spaces (normal and offset), LENS_FIELDS if
the lens zooms, and the wind to the East and North if there is wind.

centre, radius, height : the target's cylinder, W, metres
place : reference (u, v) of its centre, half frames
half_width, half_height : tan of half the fields of view
inside : margin of the target to the frame's left, right, bottom and top edge, half frames
aim : reference yaw and pitch, rad
state : reference state
tangent : unit vector along the reference path
lag, framing, visibility, aiming, state_weight, jerk, angular_jerk, time, pace : weights of the cost
nominal : one over the stage's length in the initial guess, 1 / s
"""

LENS_FIELDS = {
    "lens": 1,
    "spread": 1,
    "lens_off": 1,
    "spread_off": 1,
    "lens_still": 1,
    "lens_acceleration": 1,
}
"""The parameters of a lens that zooms, and their sizes.

lens : reference of the natural logarithm of tan of half the horizontal field of view
spread : reference of the same plus the logarithm of the distance to the target (metres): the target's size
lens_off, spread_off : weights of the squared errors of these two
lens_still, lens_acceleration : weights of the squared rate and acceleration of the field of view
"""


@dataclass(frozen=True, slots=True)
class StageSymbols:
    """Symbols of one stage.

    z : state and input
    p : parameters
    following : the next state
    node : cost of the state
    passing : cost of the way to the next node
    held : bounded functions of the state
    driven : bounded functions of state and input
    node_roots, passing_roots : columns whose squares are added to these costs; their Hessian is that of
        Gauss-Newton: it is never negative and costs half as much to compute
    """

    z: Any
    p: Any
    following: Any
    node: Any
    passing: Any
    held: Any
    driven: Any
    node_roots: Any = field(default_factory=partial(ca.SX, 0, 1))
    passing_roots: Any = field(default_factory=partial(ca.SX, 0, 1))

    @property
    def end_cost(self) -> Any:
        """Whole cost of the state."""
        return self.node + ca.sumsqr(self.node_roots)

    @property
    def cost(self) -> Any:
        """Whole cost of the state and of the way to the next node."""
        return self.end_cost + self.passing + ca.sumsqr(self.passing_roots)


def stage(
    visibility: Visibility, planes: int, extents: int = 0, windy: bool = False, zooms: bool = False
) -> StageSymbols:
    """Return a stage with ``planes`` half-spaces.

    held is the squared horizontal airspeed, the squared acceleration, then the slacks of the half-spaces
    (metres). driven is the squared jerk.

    extents : number of the target's bodies, 0 for one upright cylinder
    windy : whether there is wind
    zooms : whether the field of view is part of the problem
    """
    states = STATES + LENS_STATES * zooms
    z = ca.SX.sym("z", states + INPUTS + LENS_INPUTS * zooms)
    p = ca.SX.sym("p", size(planes, extents, windy, zooms))
    x, u = z[:states], z[states:]
    given = cut(p, FIELDS)
    first = size(planes, extents) - 4 * planes
    if zooms:
        given |= cut(p[first + 4 * planes :], LENS_FIELDS)
        half = ca.tan(x[LENS] / 2)
        given |= {"half_width": half, "half_height": half * given["half_height"] / given["half_width"]}
    position = x[POSITION]
    offset = given["centre"] - position
    distance = ca.sqrt(ca.sumsqr(offset) + 1e-9)
    view = _to_camera(offset, x[YAW], x[PITCH])
    node = (
        given["framing"] * _framing(view, distance, given)
        + given["aiming"] * _aiming(x, given)
        + ca.dot(given["state_weight"], (x[:STATES] - given["state"]) ** 2)
        + given["lag"] * ca.dot(given["tangent"], position - given["state"][POSITION]) ** 2
    )
    if visibility != "none":
        bodies = _bodies(p, view, x, given, extents)
        node += given["visibility"] * _cropped(visibility, x, bodies, distance, given)
    length = u[LENGTH]
    passing = (
        length * (given["jerk"] * ca.sumsqr(u[JERK]) + given["time"])
        + length * given["angular_jerk"] * (u[YAW_JERK] ** 2 + u[PITCH_JERK] ** 2)
        + given["pace"] * (length * given["nominal"] - 1) ** 2
    )
    if zooms:
        node += _off_lens(x, distance, given)
        passing += length * given["lens_acceleration"] * u[LENS_ACCELERATION] ** 2
    slack = [
        ca.dot(p[first + 4 * i : first + 4 * i + 3], position) - p[first + 4 * i + 3] for i in range(planes)
    ]
    level = x[VELOCITY][:2] - p[-WIND_PARAMETERS:] if windy else x[VELOCITY][:2]
    held = ca.vertcat(ca.sumsqr(level), ca.sumsqr(x[ACCELERATION]), *slack)
    return StageSymbols(z, p, _following(x, u), node, passing, held, ca.sumsqr(u[JERK]))


def size(planes: int, extents: int = 0, windy: bool = False, zooms: bool = False) -> int:
    """Return the number of parameters of a stage."""
    lens = sum(LENS_FIELDS.values()) * zooms
    return sum(FIELDS.values()) + EXTENT_PARAMETERS * extents + 4 * planes + lens + WIND_PARAMETERS * windy


def cut(p: Any, fields: Mapping[str, int]) -> dict[str, Any]:
    """Return the first numbers of a parameter vector as fields of these sizes."""
    parts, at = {}, 0
    for name, width in fields.items():
        parts[name] = p[at : at + width]
        at += width
    return parts


def _following(x: Any, u: Any) -> Any:
    """Return the state after the stage: integrators under constant jerk, exact."""
    h = u[LENGTH]

    def integrated(q: Any, v: Any, a: Any, j: Any) -> tuple[Any, Any, Any]:
        return q + h * (v + h * (a / 2 + h * j / 6)), v + h * (a + h * j / 2), a + h * j

    moved = integrated(x[POSITION], x[VELOCITY], x[ACCELERATION], u[JERK])
    yaw = integrated(x[YAW], x[YAW_RATE], x[YAW_ACCELERATION], u[YAW_JERK])
    pitch = integrated(x[PITCH], x[PITCH_RATE], x[PITCH_ACCELERATION], u[PITCH_JERK])
    whole = [*moved, *yaw, *pitch, x[TIME] + h]
    if x.numel() > STATES:
        v, a = x[LENS_RATE], u[LENS_ACCELERATION]
        whole += [x[LENS] + h * (v + h * a / 2), v + h * a]
    return ca.vertcat(*whole)


def _to_camera(d: Any, yaw: Any, pitch: Any) -> tuple[Any, Any, Any]:
    """Return a vector of W in camera axes: right, up, forward (roll is zero)."""
    along = ca.cos(yaw) * d[0] + ca.sin(yaw) * d[1]
    right = ca.sin(yaw) * d[0] - ca.cos(yaw) * d[1]
    return (
        right,
        ca.cos(pitch) * d[2] - ca.sin(pitch) * along,
        ca.cos(pitch) * along + ca.sin(pitch) * d[2],
    )


def _framing(view: tuple[Any, Any, Any], distance: Any, given: dict[str, Any]) -> Any:
    """Return c_f of Gebhardt and Hilliges, Eq. 3: squared distance of unit rays, here in half frames.

    The components are divided by half the screen's width and height (the forward one by the width), so that
    the effect of a weight does not depend on the lens.
    """
    place, wide, tall = given["place"], given["half_width"], given["half_height"]
    ray = ca.vertcat(place[0] * wide, place[1] * tall, 1)
    apart = ca.vertcat(*view) / distance - ray / ca.norm_2(ray)
    return ca.sumsqr(apart / ca.vertcat(wide, tall, wide))


def _aiming(x: Any, given: dict[str, Any]) -> Any:
    aim = given["aim"]
    return ca.cos(aim[1]) ** 2 * (x[YAW] - aim[0]) ** 2 + (x[PITCH] - aim[1]) ** 2


def _off_lens(x: Any, distance: Any, given: dict[str, Any]) -> Any:
    """Return the cost of the lens: errors of the field of view and of the target's size, and its rate.

    Both errors are differences of logarithms: a lens that is wider by a share shrinks the picture as much as
    a distance that is longer by that share.
    """
    wide = ca.log(given["half_width"])
    return (
        given["lens_off"] * (wide - given["lens"]) ** 2
        + given["spread_off"] * (wide + ca.log(distance) - given["spread"]) ** 2
        + given["lens_still"] * x[LENS_RATE] ** 2
    )


class _Body(NamedTuple):
    """A body of the target in camera axes (right, up, forward).

    view : its centre
    sides : its half-sides; empty for a cylinder
    """

    view: tuple[Any, Any, Any]
    radius: Any
    height: Any
    sides: tuple[tuple[Any, Any, Any], ...] = ()


def _bodies(
    p: Any, view: tuple[Any, Any, Any], x: Any, given: dict[str, Any], extents: int
) -> tuple[_Body, ...]:
    """Return the bodies of the target in camera axes; view : of the target's centre."""
    if not extents:
        return (_Body(view, given["radius"], given["height"]),)
    bodies, at = [], sum(FIELDS.values())
    for first in range(at, at + EXTENT_PARAMETERS * extents, EXTENT_PARAMETERS):
        extent = Extent.of(p[first : first + EXTENT_PARAMETERS])
        off = _to_camera(extent.offset, x[YAW], x[PITCH])
        seen = (view[0] + off[0], view[1] + off[1], view[2] + off[2])
        sides = (_to_camera((a[0], a[1], 0.0), x[YAW], x[PITCH]) for a in (extent.along, extent.across))
        bodies.append(_Body(seen, extent.radius, extent.height, tuple(sides)))
    return tuple(bodies)


def _cropped(visibility: Visibility, x: Any, bodies: tuple[_Body, ...], distance: Any, given: Any) -> Any:
    """Return c_v: the squared lack of the target's margin inside the frame, half frames.

    A margin is the distance from a plane of the frustum over half a frame at the target's distance.
    """
    sin, cos = ca.sin(x[PITCH]), ca.cos(x[PITCH])
    exact = visibility == "silhouette"
    cost = 0.0
    for index, (axis, sign) in enumerate(EDGES):
        half = given["half_height" if axis == UP else "half_width"]
        normal = ca.sqrt(1 + half**2)
        up = (half * sin + (sign * cos if axis == UP else 0)) / normal
        for body in bodies:
            reach = _reach(up, body, _EdgePlane(half / normal, sign / normal, axis)) if exact else 0.0
            for point in [body.view] if exact else _hull_points(body, x):
                gap = half * point[AHEAD] + sign * point[axis] - normal * reach
                cost += ca.fmax(0, given["inside"][index] - gap / (half * distance)) ** 2
    return cost


class _EdgePlane(NamedTuple):
    """The unit normal of a plane of the frustum: its components forward and along an axis of the camera."""

    ahead: Any
    lateral: Any
    axis: int


def _reach(up: Any, body: _Body, plane: _EdgePlane) -> Any:
    """Return how far a body reaches along a unit normal; up : the normal's component upwards in W."""
    far = body.height / 2 * ca.sqrt(up**2 + 1e-8) + body.radius * ca.sqrt(1 - up**2 + 1e-6)
    for side in body.sides:
        along = plane.ahead * side[AHEAD] + plane.lateral * side[plane.axis]
        far += rounded(along, side[0] ** 2 + side[1] ** 2 + side[2] ** 2)
    return far


def _hull_points(body: _Body, x: Any) -> list[tuple[Any, Any, Any]]:
    """Return top, bottom, left and right of Eq. 4-7 in camera axes; top is above bottom in W.

    Left and right have the height of the centre in the picture, and are perpendicular to the horizontal view
    of it. So they are defined wherever the camera looks at its target, also from straight above.
    """
    right, up, ahead = body.view
    half, sin, cos = body.height / 2, ca.sin(x[PITCH]), ca.cos(x[PITCH])
    level = ca.sqrt(right**2 + ahead**2 + 1e-9)
    wide = body.radius
    for side in body.sides:
        part = (ahead * side[RIGHT] - right * side[AHEAD]) / level
        wide += rounded(part, side[0] ** 2 + side[1] ** 2 + side[2] ** 2)
    lateral = wide / level
    across, along = lateral * ahead, -lateral * right
    return [
        (right, up + half * cos, ahead + half * sin),
        (right, up - half * cos, ahead - half * sin),
        (right - across, up, ahead - along),
        (right + across, up, ahead + along),
    ]
