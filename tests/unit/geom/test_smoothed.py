"""Smoothing of recorded tracks: what it leaves alone, and what of the noise it takes away."""

from __future__ import annotations

from math import cos, dist, sin, sqrt
from random import Random

import numpy as np
import pytest

from shotc.geom.smoothed import farthest, scatter, smoothed
from shotc.geom.track import Track
from shotc.geom.vec import Vec3


def track(times: list[float], place) -> Track:
    return Track(tuple(times), tuple(place(t) for t in times))


def rms(offsets: list[Vec3]) -> float:
    return sqrt(sum(x * x + y * y + z * z for x, y, z in offsets) / len(offsets))


def ring(t: float) -> Vec3:
    """A cyclist at 6 m/s round a bend of 20 m, on a climb."""
    return (20 * cos(0.3 * t), 20 * sin(0.3 * t), 0.15 * t)


@pytest.mark.parametrize("times", [[float(t) for t in range(40)], [t + 0.3 * (t % 3) for t in range(40)]])
def test_even_motion_and_one_acceleration_stay_as_they_are_to_the_ends(times: list[float]) -> None:
    for before in (track(times, lambda t: (3 * t, -t, 0.1 * t)), track(times, lambda t: (t * t, 5 - t, 2.0))):
        assert farthest(before.points, smoothed(before, 2.0).points) < 1e-9


def test_it_is_the_parabola_of_least_weighted_squares() -> None:
    random = Random(3)
    times = sorted(random.uniform(0, 30) for _ in range(60))
    noisy = track(times, lambda t: (random.gauss(0, 1), t, 0.0))
    after = smoothed(noisy, 1.5)
    for t, (x, _, _) in zip(times, after.points, strict=True):
        near = [i for i, s in enumerate(times) if abs(s - t) <= 4.5]
        u = np.array([times[i] - t for i in near])
        weights = np.exp(-0.25 * (u / 1.5) ** 2)  # polyfit squares them
        fitted = np.polyfit(u, [noisy.points[i][0] for i in near], 2, w=weights)
        assert x == pytest.approx(fitted[-1], abs=1e-9)


def test_noise_is_taken_and_a_bend_is_kept() -> None:
    random = Random(1)
    times = [float(t) for t in range(300)]
    clean = track(times, ring)
    noisy = clean._replace(
        points=tuple(
            (x + random.gauss(0, 0.3), y + random.gauss(0, 0.3), round(z + random.gauss(0, 1), 1))
            for x, y, z in clean.points
        )
    )
    calm = smoothed(noisy, 2.0)
    assert rms([off for _, off in scatter(clean, 1.0, 0, 300)]) < 0.02
    assert rms([off for _, off in scatter(noisy, 1.0, 0, 300)]) > 0.4
    assert rms([off for _, off in scatter(calm, 1.0, 0, 300)]) < 0.03
    errors = [[dist(p, q) for p, q in zip(t.points, clean.points, strict=True)] for t in (noisy, calm)]
    assert sum(errors[1]) < 0.6 * sum(errors[0])


def test_rows_too_far_apart_to_say_anything_of_each_other_stay() -> None:
    sparse = track([0.0, 20.0, 21.0, 60.0], lambda t: (sin(t), t, 0.0))
    assert smoothed(sparse, 2.0).points == sparse.points
    assert smoothed(track([0.0, 9.0], ring), 4.0).points == track([0.0, 9.0], ring).points


def test_headings_are_smoothed_with_the_places() -> None:
    random = Random(2)
    times = [float(t) for t in range(50)]
    turning = [0.1 * t + random.gauss(0, 0.2) for t in times]
    calm = smoothed(track(times, ring)._replace(headings=tuple(turning)), 3.0)
    off = [[h - 0.1 * t for h, t in zip(each, times, strict=True)] for each in (turning, calm.headings)]
    assert sum(x * x for x in off[1]) < 0.3 * sum(x * x for x in off[0])


def test_the_scatter_of_a_part_is_that_of_the_whole_there() -> None:
    times = tuple(0.5 * k for k in range(60))
    noise = np.random.default_rng(3).normal(size=(60, 3))
    track = Track(times, tuple(map(tuple, noise.tolist())))
    whole, part = scatter(track, 1.0, 0.0, 30.0), scatter(track, 1.0, 10.0, 20.0)
    assert [t for t, _ in part] == [t for t in times if 10.0 <= t <= 20.0]
    for time, off in part:
        assert off == pytest.approx(dict(whole)[time], abs=1e-12)


def test_the_farthest_of_two_sets_of_places_is_the_longest_way_between_them() -> None:
    before = [(0.0, 0.0, 0.0), (1.0, 1.0, 1.0)]
    assert farthest(before, [(0.0, 3.0, 4.0), (1.0, 1.0, 2.0)]) == 5.0
    assert farthest([], []) == 0.0
