"""Shares of outlines that are covered, against many random rays that know nothing of rectangles."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.geom.outline import (
    OutlineRays,
    covered_by_ball,
    covered_by_solid,
    covered_by_surface,
    near_solid,
    outline_boards,
    outline_rays,
    share_of,
)
from shotc.geom.pieces import Mask
from shotc.geom.shapes import BoxShape, CylinderShape, GroupShape, Part, TargetShape, bodies_of
from shotc.geom.solid_arrays.points import signed_distance
from shotc.geom.solid_arrays.segments import blocks
from shotc.geom.solids import Cylinder, Prism, Solid, box
from shotc.geom.surface.occlusion import candidates, in_the_way, stopped
from shotc.geom.surface.tree import Surface, surface_of
from shotc.geom.vec import Vec3

RAYS = 60_000
RIDER = CylinderShape(0.4, 1.9)


def rays_to(shape: TargetShape, centre: Vec3, eyes: Array) -> OutlineRays:
    return outline_rays(shape, centre, outline_boards(shape, centre, eyes))


def by_surface(rays: OutlineRays, surface: Surface) -> Mask:
    return covered_by_surface(rays, surface, in_the_way(surface, rays.boards, rays.own.shape[1]))


def meets(solid: Solid, eye: Array, way: Array) -> Array:
    """How far from the eye rays of unit directions (N, 3) enter a convex solid, metres; inf for never."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.sort((np.array([[solid.bottom], [solid.top]]) - eye[2]) / way[:, 2], axis=0)
        first, last = ends[0], ends[1]
        if isinstance(solid, Cylinder):
            flat = eye[:2] - np.array(solid.centre)
            a, b, c = (way[:, :2] ** 2).sum(1), way[:, :2] @ flat, flat @ flat - solid.radius**2
            root = np.sqrt(b * b - a * c)
            first, last = (
                np.fmax(first, (-b - root) / a),
                np.where(np.isnan(root), -1, np.fmin(last, (root - b) / a)),
            )
        else:
            for p, q in zip(solid.points, (*solid.points[1:], solid.points[0]), strict=True):
                out = np.array([q[1] - p[1], p[0] - q[0]])
                at, slope = (np.array(p) - eye[:2]) @ out, way[:, :2] @ out
                first = np.where(slope < 0, np.fmax(first, at / slope), first)
                last = np.where(slope > 0, np.fmin(last, at / slope), last)
        first = np.fmax(first, 0.0)
    return np.where(last > first, first, np.inf)


def reference(shape: TargetShape, eye: Array, solids: list[Solid], random: np.random.Generator) -> float:
    """The share that solids cover, of rays that are even on a plane across the line of sight."""
    ahead = -eye / np.linalg.norm(eye)
    side = np.cross(ahead, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side)
    reach = 1.5 * np.hypot(shape.radius, 0.5 * shape.height) * random.uniform(-1, 1, (2, RAYS))
    points = reach[0][:, None] * side + reach[1][:, None] * np.cross(side, ahead)
    way = points - eye
    way /= np.linalg.norm(way, axis=1)[:, None]
    own = np.min([meets(b.shape.solid(b.offset), eye, way) for b in bodies_of(shape)], axis=0)
    seen = np.isfinite(own)
    before = np.min([np.full(RAYS, np.inf), *(meets(solid, eye, way) for solid in solids)], axis=0)
    return float((before[seen] < own[seen]).mean())


def triangles(solid: Prism) -> Array:
    """The sides and the lid of a prism of four corners."""
    low, high = ([(*p, z) for p in solid.points] for z in (solid.bottom, solid.top))
    quads = [(low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]) for i in range(4)]
    return np.array([t for a, b, c, d in [*quads, tuple(high)] for t in ((a, b, c), (a, c, d))], dtype=float)


SHAPES = [
    RIDER,
    CylinderShape(4.0, 24.0),
    BoxShape(4.5, 1.8, 1.5, (0.6, 0.8)),
    GroupShape(
        (Part((0.0, 0.0, 2.0), CylinderShape(2.0, 20.0)), Part((6.0, 0.0, -4.0), BoxShape(8.0, 5.0, 8.0)))
    ),
]


def scene(random: np.random.Generator, size: float) -> tuple[Array, list[Solid]]:
    """An eye, and posts and walls between it and the origin."""
    eye = random.normal(size=3)
    eye *= random.uniform(2.0, 12.0) * size / np.linalg.norm(eye)
    eye[2] = abs(eye[2])
    solids: list[Solid] = []
    for _ in range(2):
        x, y, z = eye * random.uniform(0.3, 0.7) + 0.4 * size * random.normal(size=3)
        wide, tall = 0.1 * size, 0.3 * size
        solids.append(Cylinder((x, y), wide, z - tall, z + tall))
        solids.append(box((x - wide, y, z), (wide, 3 * wide, tall), 0.4))
    return eye, solids


@pytest.mark.long
def test_shares_are_those_of_many_rays() -> None:
    random, errors, partly = np.random.default_rng(4), [], 0
    for shape in SHAPES:
        for _ in range(15):
            eye, solids = scene(random, max(shape.radius, shape.height))
            rays = rays_to(shape, (0.0, 0.0, 0.0), eye[None])
            covered = np.any([covered_by_solid(rays, solid) for solid in solids], axis=0)
            wanted = reference(shape, eye, solids, random)
            errors.append(abs(float(share_of(rays, covered)[0]) - wanted))
            partly += 0.02 < wanted < 0.98
    assert partly > 20
    assert np.mean(errors) < 0.01
    assert np.max(errors) < 0.08


@pytest.mark.parametrize("shape", SHAPES)
def test_a_surface_covers_what_its_solid_does(shape: TargetShape) -> None:
    random = np.random.default_rng(6)
    for _ in range(10):
        eye, solids = scene(random, max(shape.radius, shape.height))
        rays = rays_to(shape, (0.0, 0.0, 0.0), eye[None])
        walls = [solid for solid in solids if isinstance(solid, Prism)]
        meshes = [by_surface(rays, surface_of(triangles(wall))) for wall in walls]
        for wall, mesh in zip(walls, meshes, strict=True):
            assert np.mean(covered_by_solid(rays, wall) != mesh) < 0.01


def test_a_ball_covers_what_a_disc_as_large_does() -> None:
    eye = np.array([[-20.0, 0.0, 0.0]])
    rays = rays_to(CylinderShape(1.0, 2.0), (0.0, 0.0, 0.0), eye)
    covered = share_of(rays, covered_by_ball(rays, np.array([[-10.0, 0.0, 0.0]]), 0.25))
    assert covered[0] == pytest.approx(np.pi * 0.5**2 / 4.0, abs=0.05)
    assert share_of(rays, covered_by_ball(rays, np.array([[10.0, 0.0, 0.0]]), 0.25))[0] == 0.0
    assert share_of(rays, covered_by_ball(rays, np.array([[-20.0, 0.1, 0.0]]), 0.25))[0] == 0.0


def test_what_touches_is_within_or_behind_covers_nothing_and_what_holds_the_target_all() -> None:
    eyes = np.array([[-20.0, 0.0, 3.0], [-15.0, 6.0, 0.2], [0.3, 0.2, 30.0]])
    rays = rays_to(RIDER, (0.0, 0.0, 0.95), eyes)
    behind = box((3.0, 0.0, 1.0), (2.0, 9.0, 2.0), 0.0)
    within = Cylinder((0.0, 0.0), 0.3, 0.1, 1.8)
    ground = surface_of(np.array([[[-99, -99, 0], [99, -99, 0], [0, 99, 0.0]]], dtype=float))
    assert not covered_by_solid(rays, behind).any()
    assert not covered_by_solid(rays, within).any()
    assert not by_surface(rays, ground).any()
    assert (share_of(rays, covered_by_solid(rays, box((0.0, 0.0, 1.0), (3.0, 3.0, 3.0), 0.0))) == 1.0).all()
    assert not covered_by_solid(rays, box((-18.0, 2.0, 1.0), (90.0, 90.0, 90.0), 0.0)).any()


def test_rays_go_on_beyond_all_of_a_target_however_it_stands() -> None:
    eyes = np.array([[0.1, 0.0, 30.0], [20.0, 0.0, 0.0]])
    post, ball = CylinderShape(0.5, 20.0), CylinderShape(0.2, 0.4)
    both = GroupShape((Part((0.0, 0.0, 0.0), ball), Part((0.0, 0.0, -10.0), ball)))
    for shape in (post, both):
        through = outline_boards(shape, (0.0, 0.0, 0.0), eyes).through
        assert through[0] > 40.0 / 30.0
        assert through[1] > 20.5 / 20.0


def test_an_eye_within_its_target_sees_no_outline() -> None:
    rays = rays_to(CylinderShape(2.0, 4.0), (0.0, 0.0, 0.0), np.array([[0.1, 0.0, 0.0]]))
    assert share_of(rays, rays.own).tolist() in ([0.0], [1.0])


@pytest.mark.long
@pytest.mark.parametrize("size", [0.2, 5.0, 60.0])
def test_what_is_left_out_is_in_the_way_of_no_ray(size: float) -> None:
    """Triangles that cross, touch and lie far beside the rays, and flat ones that the target stands on."""
    random = np.random.default_rng(8)
    middles = random.uniform(-25.0, 25.0, (3000, 1, 3))
    loose = middles + random.normal(0.0, size, (3000, 3, 3))
    flat = middles * [1.0, 1.0, 0.0] + random.normal(0.0, size, (3000, 3, 3)) * [1.0, 1.0, 0.0]
    surface = surface_of(np.concatenate([loose, flat]))
    eyes = random.uniform([-20.0, -20.0, -5.0], [20.0, 20.0, 35.0], (40, 3))
    for shape in SHAPES:
        rays = rays_to(shape, (0.0, 0.0, 0.5 * shape.height), eyes)
        some, every = in_the_way(surface, rays.boards, rays.own.shape[1]), candidates(surface, rays.boards)
        assert len(some) < len(every)
        hits = [stopped(surface, rays.boards, pairs, np.ones_like(rays.reach)) for pairs in (some, every)]
        assert hits[0].any()
        assert (hits[0] == hits[1]).all()


@pytest.mark.slow
def test_what_is_not_near_is_in_the_way_of_no_ray() -> None:
    """Solids before, beside and behind outlines: most are left out, and what is covered is as with all."""
    random, near = np.random.default_rng(9), []
    for shape in SHAPES:
        for _ in range(20):
            eye, solids = scene(random, max(shape.radius, shape.height))
            rays = rays_to(shape, (0.0, 0.0, 0.0), eye[None])
            for solid in solids:
                outside = signed_distance(solid, eye[None]) > 0.0
                every = blocks(solid, *rays.segments(rays.own)) & outside
                assert (covered_by_solid(rays, solid)[rays.own] == every).all()
                near.append(near_solid(rays.boards, solid)[0])
    assert 0.1 < np.mean(near) < 0.9
