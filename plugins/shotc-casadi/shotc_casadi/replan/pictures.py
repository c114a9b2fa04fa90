"""How subjects appear, in symbols: the terms of Naegeli et al., Eq. 7 to 13."""

from __future__ import annotations

from typing import Any, NamedTuple

import casadi as ca

from shotc_casadi.replan.keeping import length

INFLATED_RATIO = 1.3
"""Factor on the ellipsoid of a body that may cover a subject."""
FIELD_M = 0.8
"""How far the potential field of a body reaches beyond its ellipsoid, metres."""
EACH_PARAMETERS, COMMON_PARAMETERS = 9, 10


class Symbols(NamedTuple):
    """A subject at a stage.

    point, centre, view : as of ``FilmedSubject`` and ``Appearance``
    uv, size, diameter, axes : likewise
    placed, sized, viewed : 1 if this is asked for, else 0
    """

    point: Any
    centre: Any
    view: Any
    uv: Any
    size: Any
    diameter: Any
    axes: Any
    placed: Any
    sized: Any
    viewed: Any

    @classmethod
    def of(cls, p: Any, g: Any) -> Symbols:
        """Return the subject of its EACH_PARAMETERS of a stage and COMMON_PARAMETERS of all stages."""
        return cls(p[:3], p[3:6], p[6:9], g[:2], g[2], g[3], g[4:7], g[7], g[8], g[9])


class CameraSymbols(NamedTuple):
    """Position, yaw, pitch and tan of half the fields of view (2,)."""

    place: Any
    yaw: Any
    pitch: Any
    half: Any

    def seen(self, d: Any) -> Any:
        """Return a vector of W in camera axes: right, up, forward."""
        along = ca.cos(self.yaw) * d[0] + ca.sin(self.yaw) * d[1]
        right = ca.sin(self.yaw) * d[0] - ca.cos(self.yaw) * d[1]
        sine, cosine = ca.sin(self.pitch), ca.cos(self.pitch)
        return ca.vertcat(right, cosine * d[2] - sine * along, cosine * along + sine * d[2])

    @property
    def ahead(self) -> Any:
        """Unit vector along the camera's axis."""
        level = ca.cos(self.pitch)
        return ca.vertcat(level * ca.cos(self.yaw), level * ca.sin(self.yaw), ca.sin(self.pitch))


def off_place(camera: CameraSymbols, subject: Symbols) -> Any:
    """Return the difference of unit rays as a column; half frames near the middle of the picture (Eq. 7)."""
    ray, half = subject.point - camera.place, camera.half
    direction = ca.vertcat(subject.uv[0] * half[0], subject.uv[1] * half[1], 1)
    apart = camera.seen(ray) / length(ray) - direction / ca.norm_2(direction)
    return subject.placed * apart / ca.vertcat(half[0], half[1], half[0])


def off_size(camera: CameraSymbols, subject: Symbols) -> Any:
    """Return the logarithm of the size asked for over the size (Eq. 8)."""
    distance = length(subject.point - camera.place)
    return subject.sized * ca.log(2 * camera.half[1] * distance * subject.size / subject.diameter)


def off_view(camera: CameraSymbols, subject: Symbols) -> Any:
    """Return the difference of unit vectors from the subject to the camera (Eq. 9), as a column."""
    ray = camera.place - subject.point
    return subject.viewed * (ray / length(ray) - subject.view)


def clear(place: Any, subject: Symbols) -> Any:
    """Return the approximate distance from the ellipsoid, metres (Eq. 13); exact along its shortest axis."""
    scaled = length((place - subject.centre) / subject.axes)
    return (scaled - 1) * ca.mmin(subject.axes)


def in_field(place: Any, subject: Symbols) -> Any:
    """Return the approximate depth in the field of the ellipsoid, metres (Eq. 12)."""
    axes = subject.axes + FIELD_M
    return ca.fmax(0, 1 - length((place - subject.centre) / axes)) * ca.mmin(axes)


def uncovered(place: Any, subject: Symbols, other: Symbols) -> Any:
    """Return the slack to covering the subject's point by another body; >= 0 where the point is visible.

    This is Eq. 11 with the horizon: in coordinates in which the body is the unit ball, the ray passes its
    centre at 1 or more, or the point is before the plane through its horizon.
    """
    axes = INFLATED_RATIO * other.axes
    to_point, to_body = (subject.point - place) / axes, (other.centre - place) / axes
    horizon = ca.sumsqr(to_body) - 1
    along = ca.dot(to_point, to_body)
    inside = along**2 / (ca.sumsqr(to_point) + 1e-9) - horizon
    return -ca.fmin(inside, along - horizon)
