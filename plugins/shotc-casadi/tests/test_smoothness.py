"""Every function that the solvers call has a value and derivatives wherever a camera may be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from math import pi, tan
from typing import Any, NamedTuple, get_args

import casadi as ca
import numpy as np
import pytest
from shotc_casadi import symbols as path
from shotc_casadi.clock import picture
from shotc_casadi.clock import symbols as clock
from shotc_casadi.conditions import Visibility
from shotc_casadi.derivatives import Derived, derived
from shotc_casadi.extents import extents_of

from shotc.geom.shapes import BoxShape, CylinderShape, GroupShape, Part

Array = np.ndarray


class PathKind(NamedTuple):
    """A stage of a shot on a path: how its target is kept whole, and how many bodies that is made of."""

    visibility: Visibility
    extents: int


KINDS = [
    *((PathKind(visibility, 0), 1) for visibility in get_args(Visibility)),
    *((PathKind(visibility, 2), 1) for visibility in ("silhouette", "points")),
    *((sizes, 0) for sizes in ((1, 0, 0, 0), (1, 1, 1, 0), (1, 1, 1, 2), (0, 1, 1, 3), (0, 0, 0, 2, 2))),
]
RADIUS, HEIGHT = 0.5, 2.0  # with places on a grid, heights are equal to the last digit
DRAWS = 5
NUDGE = 1e-9
SMOOTH = 1e-4  # of the gradient: what such a step may change of it


class Scene(NamedTuple):
    """A camera and what it films: where they are, W, how they move (3, 3), and how the camera looks."""

    eye: Array
    motion: Array
    aim: Array
    centre: Array
    moves: Array


def drawn(rng: np.random.Generator) -> Scene:
    """A camera some metres from a subject that it looks at, nearly."""
    centre = np.round(4 * rng.uniform(-20, 20, 3)) / 4
    around, above, far = rng.uniform(-pi, pi), rng.uniform(-0.3, 1.0), rng.uniform(3, 20)
    away = far * np.array([np.cos(around) * np.cos(above), np.sin(around) * np.cos(above), np.sin(above)])
    aim = np.array([around + pi, -above]) + rng.uniform(-0.2, 0.2, 2)
    return Scene(centre + away, rng.normal(0, 1, (3, 3)), aim, centre, rng.normal(0, 1, (3, 3)))


def lifted(scene: Scene, up: float, **more: Any) -> Scene:
    """The camera as high as a place on the subject, as a share of its height from its middle."""
    return scene._replace(eye=np.array([*scene.eye[:2], scene.centre[2] + up * HEIGHT]), **more)


def level(scene: Scene, *, off: tuple[float, float] = (0.0, 0.0), up: float = 0.0) -> Scene:
    """The camera south of the subject, looking level and north, to the last digit."""
    eye = scene.centre + np.array([0.0, -8.0, up * HEIGHT])
    return scene._replace(eye=eye, aim=np.array([0.5 * pi + off[0], off[1]]))


def over(scene: Scene, high: float) -> Scene:
    """The camera straight above the subject, or below it, looking at it."""
    eye = scene.centre + np.array([0.0, 0.0, high])
    return scene._replace(eye=eye, aim=np.array([0.3, -np.sign(high) * 0.5 * pi]))


def still(scene: Scene) -> Scene:
    return scene._replace(motion=0 * scene.motion, moves=0 * scene.moves)


def at_the_edge(scene: Scene) -> Scene:
    """The subject's middle at the edge of the frame."""
    return level(scene, off=(np.arctan(LENS[0]), 0.0))


HALF = tan(0.6)
LENS = np.array([HALF, HALF / (16 / 9)])
PLACES: dict[str, Callable[[Scene], Scene]] = {
    "anywhere": lambda s: s,
    "as high as the top": lambda s: lifted(s, 0.5),
    "as high as the foot": lambda s: lifted(s, -0.5),
    "at eye level": level,
    "level with the top": lambda s: level(s, up=0.5),
    "level with the foot": lambda s: level(s, up=-0.5),
    "still": lambda s: still(level(s)),
    "straight above": lambda s: over(s, 10.0),
    "straight below": lambda s: over(s, -10.0),
    "at the frame's edge": at_the_edge,
    "looking away": lambda s: s._replace(aim=s.aim + np.array([pi, 0.0])),
    "upright": lambda s: s._replace(aim=np.array([s.aim[0], 0.5 * pi])),
}
INSIDE: dict[str, Callable[[Scene], Scene]] = {
    "a millimetre away": lambda s: s._replace(eye=s.centre + np.array([1e-3, 0.0, 0.0])),
    "on the axis": lambda s: s._replace(eye=s.centre + np.array([0.0, 0.0, 0.3])),
    "in the middle": lambda s: still(s)._replace(eye=s.centre.copy()),
}


def kind_of(kind: Any, planes: int) -> Derived:
    if isinstance(kind, PathKind):
        return derived(kind.visibility, planes, kind.extents)
    return clock.derived(clock.Sizes(*kind))


def point(kind: Any, planes: int, scene: Scene, rng: np.random.Generator) -> tuple[Array, Array]:
    """State and input of a stage, and its parameters."""
    return (_on_path if isinstance(kind, PathKind) else _on_clock)(kind, planes, scene, rng)


def flat(names: dict[str, int], values: dict[str, Any]) -> Array:
    return np.concatenate([np.broadcast_to(np.asarray(values[n], float), (names[n],)) for n in names])


def _on_path(kind: PathKind, planes: int, scene: Scene, rng: np.random.Generator) -> tuple[Array, Array]:
    z = np.zeros(path.STATES + path.INPUTS)
    z[path.POSITION], z[path.VELOCITY], z[path.ACCELERATION] = scene.eye, scene.motion[0], scene.motion[1]
    z[path.YAW], z[path.PITCH] = scene.aim
    z[path.STATES : path.STATES + 3], z[path.STATES + path.LENGTH] = scene.motion[2], 0.3
    values = dict.fromkeys(path.FIELDS, 1.0) | {
        "centre": scene.centre,
        "radius": RADIUS,
        "height": HEIGHT,
        "place": (-0.3, 0.1),
        "half_width": LENS[0],
        "half_height": LENS[1],
        "aim": scene.aim,
        "state": z[: path.STATES],
    }
    bodies = _bodies(kind.extents)
    return z, np.concatenate([flat(path.FIELDS, values), bodies, rng.normal(size=4 * planes)])


def _bodies(count: int) -> Array:
    """A box that lies along the camera's axis at eye level, and a cylinder beside it; as tall, and taller."""
    box = BoxShape(4.0, 1.0, HEIGHT, (0.0, 1.0))
    both = GroupShape((Part((0.0, 0.0, 0.0), box), Part((1.5, 0.0, 1.0), CylinderShape(RADIUS, 2 * HEIGHT))))
    return extents_of(both, count, 1).ravel()


def _on_clock(kind: Any, _: int, scene: Scene, rng: np.random.Generator) -> tuple[Array, Array]:
    sizes = clock.Sizes(*kind)
    camera = [scene.aim[0], 0.0, 0.0, scene.aim[1], 0.0, 0.0] if sizes.subjects else []
    inputs = np.zeros(sizes.inputs)
    inputs[:3] = scene.motion[2]
    z = np.concatenate([scene.eye, scene.motion[0], scene.motion[1], camera, inputs])
    values = dict.fromkeys(clock.FIELDS, 1.0) | {
        "length": 0.1,
        "ideal": scene.eye,
        "target": np.concatenate([scene.centre, scene.moves.ravel()]),
        "lens": LENS,
    }
    scale = np.diag(1 / np.array([0.6, 0.6, 1.2])).ravel()
    occluder = [*scale, *(0.5 * (scene.eye + scene.centre)), 1.0, *scene.centre]
    body = [*scale, *scene.centre, 0.0, 1.5]
    parts = [flat(clock.FIELDS, values), rng.normal(size=clock.PLANE_PARAMETERS * sizes.planes)]
    parts += [np.array(occluder)] * sizes.occluders + [np.array(body)] * sizes.bodies
    for k in range(sizes.subjects):
        parts += [_subject(scene, k), _bodies(sizes.extents)]
    return z, np.concatenate(parts)


def _subject(scene: Scene, k: int) -> Array:
    """The first is where the camera looks; the others stand beside it, as tall."""
    values = dict.fromkeys(picture.FIELDS, 1.0) | {
        "centre": scene.centre + np.array([1.5 * k, 0.0, 0.0]),
        "solid": (RADIUS, HEIGHT),
        "uv": (0.2 * k, 0.0),
        "size": 0.4,
        "toward": (0.0, -1.0, 0.0),
        "elevation": 0.0,
    }
    return flat(picture.FIELDS, values)


def functions(made: Derived) -> dict[str, Any]:
    """All functions of a stage."""
    found = {f.name: getattr(made, f.name) for f in fields(made)}
    return {name: one for name, one in found.items() if isinstance(one, ca.Function)}


def evaluated(one: Any, made: Derived, z: Array, p: Array, rng: np.random.Generator) -> list[Array]:
    x = z if one.size1_in(0) == made.width else z[: made.states]
    prices = [rng.normal(size=one.size1_in(i)) for i in range(2, one.n_in())]
    return [np.array(ca.DM(part).full()) for part in one.call([x, p, *prices])]


@pytest.mark.long
@pytest.mark.parametrize("where", [*PLACES, *INSIDE])
@pytest.mark.parametrize(("kind", "planes"), KINDS)
def test_all_values_and_derivatives_are_numbers(kind: Any, planes: int, where: str) -> None:
    made, rng = kind_of(kind, planes), np.random.default_rng(7)
    assert len(functions(made)) == 11
    for _ in range(DRAWS):
        z, p = point(kind, planes, (PLACES | INSIDE)[where](drawn(rng)), rng)
        for name, one in functions(made).items():
            for part in evaluated(one, made, z, p, rng):
                assert np.isfinite(part).all(), name


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "planes"), KINDS)
def test_no_slope_jumps(kind: Any, planes: int) -> None:
    for where, moved in PLACES.items():
        made, rng = kind_of(kind, planes), np.random.default_rng(11)
        for _ in range(DRAWS):
            z, p = point(kind, planes, moved(drawn(rng)), rng)
            here = np.array(made.gradient(z, p)[1]).ravel()
            for step in rng.normal(0, NUDGE, (4, len(z))):
                there = np.array(made.gradient(z + step, p)[1]).ravel()
                assert np.abs(there - here).max() < SMOOTH * (1 + np.abs(here).max()), where
