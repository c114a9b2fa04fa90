"""Flights with effects of lights, made by hand, and the effects' colours worked out light by light."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from shotc.ir.fleet import FleetTrajectory, Lights
from shotc.ir.light_layers import FadeTimes, Layer, Look, Painted

ALWAYS = (0.0, 0.0, 100.0, 100.0)
GREY = (60, 80, 100)


def standing(places: np.ndarray, lights: Lights | None = None) -> FleetTrajectory:
    """Drones that stand for 20 s at places (n, 3), grey if no lights are given."""
    coef = np.repeat(places[:, None].astype(np.float64), 23, axis=1)
    return FleetTrajectory("swarm", np.arange(21.0), coef, (), (), lights or grey(len(places)))


def grey(n: int) -> Lights:
    rows = np.array([(0, 0, 0), GREY, GREY, (0, 0, 0)], dtype=np.uint8)
    return Lights(np.array([0.0, 2.0, 18.0, 20.0]), np.repeat(rows[None], n, axis=0))


def lit(
    places: np.ndarray,
    *layers: Layer,
    over: tuple[Layer, ...] = (),
    spare: tuple[int, ...] = (),
) -> FleetTrajectory:
    """The same with a stack over the grey, which stands from 2 s to 18 s."""
    plain = grey(len(places))
    return standing(places, replace(plain, looks=(Look(layers, spare),), of=(-1, 0, 0, -1), over=over))


def layer(paint: Painted, blend: str = "mix", opacity: float = 1.0, span=ALWAYS) -> Layer:  # type: ignore[no-untyped-def]
    return Layer(paint, blend, opacity, FadeTimes(*span))  # type: ignore[arg-type]


def line(n: int, direction: tuple[float, float, float] = (1.0, 0.0, 0.0)) -> np.ndarray:
    """Places a metre apart, 30 m up."""
    return np.arange(n)[:, None] * np.array(direction) + np.array([0.0, 0.0, 30.0])
