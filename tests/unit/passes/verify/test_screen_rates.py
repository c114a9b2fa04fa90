"""Bounds of rates on screen against a camera that zooms at a point that goes past it."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.passes.verify.close import Rates, _screen_rate

ASPECT = 16 / 9


@pytest.mark.parametrize("seed", range(40))
def test_a_place_on_screen_moves_no_faster_than_is_proved_and_the_bound_is_no_multiple(seed: int) -> None:
    random = np.random.default_rng(seed)
    start = np.array([*random.uniform(-8.0, 8.0, 2), random.uniform(10.0, 20.0)])
    velocity, dt = random.normal(size=3) * random.choice([0.0, 1.0, 4.0]), random.uniform(0.05, 0.4)
    lens, zoom = random.uniform(0.4, 1.4), random.choice([-0.3, 0.0, 0.3])
    t = np.linspace(0.0, dt, 2001)
    x, y, forward = (start[:, None] + velocity[:, None] * t).copy()
    half = np.tan(0.5 * (lens + zoom * t))
    u, v = x / (forward * half), y / (forward * half / ASPECT)
    fastest = np.hypot(np.gradient(u, t), np.gradient(v, t)).max()
    # The point seems to go by a turn of the camera, for half of its speed.
    speed = float(np.linalg.norm(velocity))
    bound = Rates(20.0, 0.5 * speed, 0.5 * speed / 20.0, abs(zoom), float(half.min()), float(half.max()))
    rows = np.column_stack([np.zeros(2001), x, y * ASPECT, forward])
    found = float(_screen_rate(bound, ASPECT, rows[:1], rows[-1:], np.array([dt]))[0])
    assert fastest <= found * (1.0 + 1e-6) + 1e-9
    direct = np.hypot(speed / (forward.min() * half.min()), ASPECT * speed / (forward.min() * half.min()))
    turned = abs(zoom) * (1.0 + half.max() ** 2) / (2.0 * half.min()) * np.hypot(u, v).max()
    assert found <= 1.6 * (direct + turned)
