"""One stage of a shot on its own clock in CasADi symbols: dynamics, cost and constraints.

State (9): position, velocity, acceleration (W, SI). Input (4): jerk; metres by which the ray leaves the
gimbal's pitch range (a slack). For several subjects the camera is part of the problem: its yaw and pitch,
each with rate and acceleration, are six more states, and their jerks are inputs instead of that slack. With
occluders, one more input is the largest occlusion; with ellipsoids to keep out of, one more is the depth in
them. A stage has a given length and a constant jerk, so the position is a cubic. Its control points, those of
the velocity and the ends of the acceleration bound it at every instant.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import casadi as ca

from shotc_casadi.clock.angles import over_ground, turning
from shotc_casadi.clock.picture import residuals, width
from shotc_casadi.derivatives import Derived, differentiated
from shotc_casadi.symbols import WIND_PARAMETERS, StageSymbols, cut

POSITION, VELOCITY, ACCELERATION = slice(0, 3), slice(3, 6), slice(6, 9)
PLACE_STATES = 9  # states of the camera's position and its derivatives
YAW, PITCH = 9, 12  # each with rate and acceleration
JERK, SLACK, CAMERA_JERK = slice(0, 3), 3, slice(3, 5)
CONTROL_POINTS = 4  # control points of a stage's position
PLANE_PARAMETERS = 5  # normal, offset at the stage's start, change of the offset over it
OCCLUDER_PARAMETERS = 13  # an occluder: see ``occlusion``
SIGHT_LINE_PARAMETERS = OCCLUDER_PARAMETERS + 3  # the same, and the point that the camera looks at
BODY_PARAMETERS = 14  # an obstacle: see ``inside``
TINY_SQUARE = 1e-9  # added to a square so that it is not zero


class Sizes(NamedTuple):
    """The parts of a stage: half-spaces, occluders, obstacles as ellipsoids, subjects in one picture.

    subjects : 0 if the camera follows one or none, and is not part of the problem
    extents : bodies of each subject, 0 if each is one upright cylinder
    windy : whether there is wind
    """

    planes: int
    occluders: int = 0
    bodies: int = 0
    subjects: int = 0
    extents: int = 0
    windy: bool = False

    @property
    def rows(self) -> tuple[tuple[int, int], ...]:
        """Number of half-spaces, occluders, bodies and subjects, and the parameters of each."""
        subject = width(self.extents)
        return (
            (self.planes, PLANE_PARAMETERS),
            (self.occluders, SIGHT_LINE_PARAMETERS),
            (self.bodies, BODY_PARAMETERS),
            (self.subjects, subject),
        )

    @property
    def states(self) -> int:
        """Number of states."""
        return PLACE_STATES + (6 if self.subjects else 0)

    @property
    def moves(self) -> int:
        """Number of inputs except the slacks of ellipsoids, which come last."""
        return 5 if self.subjects else 4

    @property
    def inputs(self) -> int:
        """Number of inputs."""
        return self.moves + (self.occluders > 0) + (self.bodies > 0)

    @property
    def slacks(self) -> dict[str, int]:
        """The inputs that are slacks of ellipsoids, by the name of their price.

        The solvers get them in units that cost 1 a stage. Multipliers start at 1; with a much larger price an
        interior-point method needs most of its steps to raise them.
        """
        inputs = {"hidden": self.moves} if self.occluders else {}
        return inputs | ({"touch": self.inputs - 1} if self.bodies else {})

    @property
    def limits(self) -> int:
        """Number of rows of ``driven`` before those of half-spaces and ellipsoids."""
        return 3 if self.subjects else 5


FIELDS = {
    "length": 1,
    "ideal": 3,
    "place": 1,
    "leash": 1,
    "drawn": 4,
    "near": 1,
    "target": 12,
    "jerk": 1,
    "turn": 6,
    "steep": 2,
    "free": 1,
    "price": 1,
    "hidden": 1,
    "field": 1,
    "touch": 1,
    "picture": 1,
    "lens": 2,
}
"""The parameters of a stage and their sizes.

Then follow: half-spaces (PLANE_PARAMETERS each), occluders (LINE each), obstacles (BODY_PARAMETERS each),
several subjects (``picture.width`` each), and the wind to the East and North if there is wind.

length : seconds
ideal : reference position of the camera, W, metres
place : weight of the squared distance to it
leash : how that weight grows with the squared distance, 1/m^2
drawn : reference yaw and pitch of the camera of several subjects, rad, and the weights of both squares
near : one over the square of the largest distance from the reference position, 1/m^2; 0 without a limit
target : its position, velocity, acceleration and jerk; of several subjects their mean's
jerk : weight of the camera's squared jerk
turn : weights of the squared yaw and pitch rate, acceleration and jerk of the ray, in the order of
    ``RayDerivatives``; of the camera, if that is part of the problem
steep : tangents of the lowest and the highest elevation of the ray that the gimbal reaches
free : metres added to that range where nothing is filmed
price : of a metre outside it
hidden : price of a hidden subject, a second and a unit of d_v
field : weight of the potential field
touch : price of being in an ellipsoid, a second
picture : weight of the appearance of several subjects
lens : tan of half the fields of view
"""


def stage(sizes: Sizes) -> StageSymbols:
    """Return a stage with that many half-spaces, ellipsoids and subjects.

    held is the squared horizontal airspeed, the squared acceleration, and the squared distance to the ideal
    place over the square of the largest one. driven has these rows:

    - the squared jerk, and the squared horizontal airspeed and the climb at the velocity's middle control
      point
    - for one subject: the slacks to the lowest and highest pitch of the gimbal, metres
    - for each half-space: the slacks of the position's control points, metres
    - for each occluder: the slack input minus d_v
    - for each obstacle: the squared unit-ball distance minus 1 plus the slack input
    """
    z, p = ca.SX.sym("z", sizes.states + sizes.inputs), ca.SX.sym("p", size(sizes))
    x, u = z[: sizes.states], z[sizes.states :]
    given, walls, sight_lines, near, subjects = _parameters(p, sizes)
    h, jerk = given["length"], u[JERK]
    place, v, a = x[POSITION], x[VELOCITY], x[ACCELERATION]
    moved = _integrated(x[:PLACE_STATES], jerk, h)
    off = ca.sumsqr(place - given["ideal"])
    aimed = _aims_at_several(x, u, given, subjects) if sizes.subjects else _aims_at_one(x, u, given)
    depths = [inside(body, place) for body in near]
    occlusions = [
        occlusion(line[:OCCLUDER_PARAMETERS], place, line[OCCLUDER_PARAMETERS:]) for line in sight_lines
    ]
    lacks = {price: u[k] / (h * given[price]) for price, k in sizes.slacks.items()}
    reached = [
        ca.sqrt(given["field"]) * ca.fmax(0.0, 1.0 - q / body[-1])
        for q, body in zip(depths, near, strict=True)
    ]
    middle, wind = v + h * a / 2, p[-WIND_PARAMETERS:] if sizes.windy else 0
    driven = ca.vertcat(
        ca.sumsqr(jerk),
        ca.sumsqr(middle[:2] - wind),
        middle[2],
        *aimed.limits,
        *_slacks(walls, place, v, moved, h),
        *(lacks["hidden"] - occlusion_at for occlusion_at in occlusions),
        *(q - 1.0 + lacks["touch"] for q in depths),
    )
    return StageSymbols(
        z,
        p,
        ca.vertcat(moved, *aimed.moved),
        node=given["place"] * off * (1 + given["leash"] * off) + aimed.node,
        passing=h * (given["jerk"] * ca.sumsqr(jerk) + aimed.slack) + ca.sum1(u[sizes.moves :]),
        held=ca.vertcat(ca.sumsqr(v[:2] - wind), ca.sumsqr(a), given["near"] * off),
        driven=driven,
        node_roots=ca.vertcat(*reached),
        passing_roots=ca.sqrt(h * given["turn"]) * aimed.turned,
    )


class _Aimed(NamedTuple):
    """What aiming the camera adds to a stage.

    turned : rates, accelerations and jerks that have a cost
    slack : cost of the pitch slack, a second
    node : cost of the state
    moved : states of the camera after the stage
    limits : rows of ``driven``
    """

    turned: Any
    slack: Any = 0.0
    node: Any = 0.0
    moved: tuple[Any, ...] = ()
    limits: tuple[Any, ...] = ()


def _aims_at_one(x: Any, u: Any, given: Mapping[str, Any]) -> _Aimed:
    """Return the terms of a camera that follows the ray to one subject within the gimbal's range."""
    t = given["target"]
    ray = t[:3] - x[POSITION]
    turned = turning(ray, t[3:6] - x[VELOCITY], t[6:9] - x[ACCELERATION], t[9:] - u[JERK])
    low, high = given["steep"][0], given["steep"][1]
    space = given["free"] + u[SLACK]
    limits = (ray[2] - low * over_ground(ray) + space, high * over_ground(ray) - ray[2] + space)
    return _Aimed(ca.vertcat(*turned), given["price"] * u[SLACK], limits=limits)


def _aims_at_several(x: Any, u: Any, given: Mapping[str, Any], subjects: Sequence[Any]) -> _Aimed:
    """Return the terms of a camera with several subjects; the camera's angles are states."""
    turns = u[CAMERA_JERK]
    moved = (_integrated(x[k : k + 3], turns[i], given["length"]) for i, k in enumerate((YAW, PITCH)))
    turned = ca.vertcat(x[YAW + 1], x[PITCH + 1], x[YAW + 2], x[PITCH + 2], turns)
    off = (residuals(one, x[POSITION], (x[YAW], x[PITCH]), given["lens"]) for one in subjects)
    # Conflicting references leave large residuals; on these Gauss-Newton needs many steps.
    node = given["picture"] * sum(map(ca.sumsqr, off)) + _off_drawn(x[YAW], x[PITCH], given["drawn"])
    return _Aimed(turned, node=node, moved=tuple(moved))


def _off_drawn(yaw: Any, pitch: Any, drawn: Any) -> Any:
    """Return the cost of the camera angles against their reference (viewpoint Eq. 10)."""
    sine = 2.0 * ca.sin(0.5 * (yaw - drawn[0]))
    return drawn[2] * sine**2 + drawn[3] * (pitch - drawn[1]) ** 2


def _integrated(x: Any, jerk: Any, h: Any) -> Any:
    """Return a value, its rate and its acceleration after a stage of constant jerk."""
    n = x.numel() // 3
    q, v, a = x[:n], x[n : 2 * n], x[2 * n :]
    return ca.vertcat(q + h * (v + h * (a / 2 + h * jerk / 6)), v + h * (a + h * jerk / 2), a + h * jerk)


def _slacks(walls: list[Any], place: Any, v: Any, following: Any, h: Any) -> list[Any]:
    """Return the slack of each control point of the position in each half-space, metres."""
    points = [
        place,
        place + h * v / 3,
        following[POSITION] - h * following[VELOCITY] / 3,
        following[POSITION],
    ]
    return [
        ca.dot(plane[:3], point) - plane[3] - (k / (CONTROL_POINTS - 1)) * plane[4]
        for plane in walls
        for k, point in enumerate(points)
    ]


def occlusion(occluder: Any, eye: Any, point: Any) -> Any:
    """Return d_v of viewpoint Eq. 11: how deep a line of sight runs in an ellipsoid, 1 through its centre.

    d_v is 1 minus the squared distance of the line from the centre, in coordinates in which the ellipsoid is
    the unit ball.

    occluder : OCCLUDER_PARAMETERS numbers: scale by columns, centre, and 1 (much less for an unused one)
    eye, point : camera and the point that it looks at, W, metres
    """
    scale, centre = ca.reshape(occluder[:9], 3, 3), occluder[9:12]
    ray, to_centre = scale @ (point - eye), scale @ (centre - eye)
    return occluder[12] - ca.sumsqr(ca.cross(to_centre, ray)) / (ca.sumsqr(ray) + TINY_SQUARE)


def inside(body: Any, eye: Any) -> Any:
    """Return the squared distance from an ellipsoid's centre, in coordinates in which it is the unit ball.

    body : BODY_PARAMETERS: scale by columns, centre, an offset of the square (0 unless it is unused), and
        the square at which the potential field ends (viewpoint Eq. 12 and 13)
    """
    scale, centre = ca.reshape(body[:9], 3, 3), body[9:12]
    return ca.sumsqr(scale @ (eye - centre)) + body[12]


@lru_cache(maxsize=16)
def derived(sizes: Sizes) -> Derived:
    """Return the functions of one stage of those sizes."""
    return differentiated(stage(sizes))


def size(sizes: Sizes) -> int:
    """Return the number of parameters of a stage."""
    return (
        sum(FIELDS.values()) + sum(count * wide for count, wide in sizes.rows) + WIND_PARAMETERS * sizes.windy
    )


class _StageParameters(NamedTuple):
    """Parameters of a stage by name, and those of each half-space, line of sight, body and subject."""

    named: dict[str, Any]
    walls: list[Any]
    sight_lines: list[Any]
    bodies: list[Any]
    subjects: list[Any]


def _parameters(p: Any, sizes: Sizes) -> _StageParameters:
    """Return the parts of a stage's vector of parameters."""
    at = sum(FIELDS.values())
    rows: list[list[Any]] = []
    for count, wide in sizes.rows:
        rows.append([p[at + wide * i : at + wide * (i + 1)] for i in range(count)])
        at += wide * count
    return _StageParameters(cut(p, FIELDS), *rows)
