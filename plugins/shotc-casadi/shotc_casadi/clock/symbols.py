"""One stage of a shot on its own clock in CasADi symbols: dynamics, cost and constraints.

State (9): position, velocity, acceleration (W, SI). Input (4): jerk; metres by which the gimbal's pitch
range is left; where something may hide the target, a fifth: by how much the worst does. Stages have given
lengths, and the jerk is even on each, so that the position is a cubic:
its control points, those of the velocity and the ends of the acceleration bound it at every instant.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import casadi as ca

from shotc_casadi.clock.angles import over_ground, turning
from shotc_casadi.clock.wishes import SCREEN
from shotc_casadi.derivatives import Derived, differentiated
from shotc_casadi.symbols import Stage

STATES, INPUTS = 9, 4
POSITION, VELOCITY, ACCELERATION = slice(0, 3), slice(3, 6), slice(6, 9)
JERK, SLACK, HIDDEN = slice(0, 3), 3, 4
POINTS = 4  # control points of a stage's position
PLANE = 5  # normal, offset at the stage's start, change of the offset over it
TINY = 1e-9  # added to a square that is not to be none

FIELDS = {
    "length": 1,
    "ideal": 3,
    "place": 1,
    "leash": 1,
    "target": 12,
    "jerk": 1,
    "turn": 6,
    "steep": 2,
    "free": 1,
    "price": 1,
    "hidden": 1,
}
"""The parameters of a stage and their sizes; half-spaces follow, PLANE numbers each, then what may hide the
target, SCREEN numbers each.

length : seconds
ideal : where the camera would be, W, metres; place : weight of the squared distance to it
leash : 1/m^2, by which that weight grows with the squared distance
target : its position, velocity, acceleration and jerk
jerk : weight of the camera's squared jerk
turn : weights of the squares of the ray's yaw and pitch rate, acceleration and jerk, as in ``Turning``
steep : tangents of the lowest and the highest elevation of the ray that the gimbal reaches
free : metres added to what that leaves, where nothing is filmed; price : of a metre that is missing
hidden : price of the target's being hidden, for a second and a unit of d_v
"""


def stage(planes: int, screens: int = 0) -> Stage:
    """Return a stage with that many half-spaces to stay in, and ellipsoids to look past.

    held is horizontal speed squared and acceleration squared. driven is jerk squared; of the velocity's
    middle control point the horizontal square and the climb; what is left of the gimbal's pitch range below
    and above, metres; then, for each half-space, the slack of the position's control points, metres; then,
    for each ellipsoid, by how much less than the input says it hides the target.
    """
    z = ca.SX.sym("z", STATES + INPUTS + (screens > 0))
    p = ca.SX.sym("p", size(planes, screens))
    x, u = z[:STATES], z[STATES:]
    given = _fields(p)
    h, jerk = given["length"], u[JERK]
    place, v, a = x[POSITION], x[VELOCITY], x[ACCELERATION]
    following = ca.vertcat(
        place + h * (v + h * (a / 2 + h * jerk / 6)), v + h * (a + h * jerk / 2), a + h * jerk
    )
    t = given["target"]
    ray = t[:3] - place
    turned = ca.vertcat(*turning(ray, t[3:6] - v, t[6:9] - a, t[9:] - jerk))
    passing = (
        h * given["jerk"] * ca.sumsqr(jerk)
        + h * ca.dot(given["turn"], turned**2)
        + h * given["price"] * u[SLACK]
    )
    first = p.numel() - PLANE * planes - SCREEN * screens
    past = p[first + PLANE * planes :]
    covers = [cover(past[SCREEN * i : SCREEN * (i + 1)], place, t[:3]) for i in range(screens)]
    if covers:
        passing += h * given["hidden"] * u[HIDDEN]
    off = ca.sumsqr(place - given["ideal"])
    node = given["place"] * off * (1 + given["leash"] * off)
    middle = v + h * a / 2
    low, high = given["steep"][0], given["steep"][1]
    room = given["free"] + u[SLACK]
    points = [
        place,
        place + h * v / 3,
        following[POSITION] - h * following[VELOCITY] / 3,
        following[POSITION],
    ]
    slack = [
        ca.dot(plane[:3], point) - plane[3] - (k / (POINTS - 1)) * plane[4]
        for plane in (p[first + PLANE * i : first + PLANE * (i + 1)] for i in range(planes))
        for k, point in enumerate(points)
    ]
    driven = ca.vertcat(
        ca.sumsqr(jerk),
        ca.sumsqr(middle[:2]),
        middle[2],
        ray[2] - low * over_ground(ray) + room,
        high * over_ground(ray) - ray[2] + room,
        *slack,
        *(u[HIDDEN] - covered for covered in covers),
    )
    held = ca.vertcat(ca.sumsqr(v[:2]), ca.sumsqr(a))
    return Stage(z, p, following, node, passing, held, driven)


def cover(screen: Any, eye: Any, point: Any) -> Any:
    """Return d_v of viewpoint Eq. 11: how far inside an ellipsoid a line of sight runs, 1 through its middle.

    screen : SCREEN numbers: scale by columns, centre, and 1, or less where there is none
    d_v is 1 less the squared distance of the line from the centre, where the ellipsoid is the unit ball.
    """
    scale, centre = ca.reshape(screen[:9], 3, 3), screen[9:12]
    ray, away = scale @ (point - eye), scale @ (centre - eye)
    return screen[12] - ca.sumsqr(ca.cross(away, ray)) / (ca.sumsqr(ray) + TINY)


@lru_cache(maxsize=8)
def derived(planes: int, screens: int = 0) -> Derived:
    """Return the functions of one stage with that many half-spaces and ellipsoids."""
    return differentiated(stage(planes, screens))


def size(planes: int, screens: int = 0) -> int:
    """Return how many parameters a stage has."""
    return sum(FIELDS.values()) + PLANE * planes + SCREEN * screens


def _fields(p: Any) -> dict[str, Any]:
    cut, at = {}, 0
    for name, width in FIELDS.items():
        cut[name] = p[at : at + width]
        at += width
    return cut
