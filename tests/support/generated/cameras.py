"""Drones with their lenses, as authors choose them."""

from __future__ import annotations

from math import degrees, radians
from typing import Any, NamedTuple

from shotc.spec.presets import PRESETS
from tests.support.generated.dice import Dice

MODELS = {"x500": 5.0, "mini": 2.0, "pro": 3.0, "solo": 1.0, "alta-x": 1.0}
LENSES_DEG = (15.0, 110.0)
ASPECTS = {"16:9": 16 / 9, "4:3": 4 / 3, "1:1": 1.0, "9:16": 9 / 16, "2.39:1": 2.39}


class Camera(NamedTuple):
    """A drone and what of it matters to where it can film from; SI and radians.

    speed : horizontal, less the wind; wanted : its YAML, without the home
    """

    name: str
    model: str
    hfov: float
    aspect: float
    speed: float
    climb: float
    descent: float
    acceleration: float
    yaw_rate: float
    pitch: tuple[float, float]
    gimbal_rate: float
    radius: float
    endurance: float
    turns_freely: bool
    wanted: dict[str, Any]


def camera(dice: Dice, name: str, wind: float, priority: int | None) -> Camera:
    """Draw a drone: a preset, often with a lens of its own, sometimes with other limits."""
    model = dice.weighted(MODELS)
    preset = PRESETS[model]
    wanted: dict[str, Any] = {"model": model}
    hfov, aspect = _lens(dice, wanted, preset.hfov, preset.aspect)
    limits, rate = preset.limits, preset.gimbal.rate
    speed, yaw_rate = limits.speed, limits.yaw_rate
    if dice.chance(0.2):
        speed = dice.between(0.8, 1.3) * speed
        wanted["limits"] = {"speed": f"{speed:.1f} m/s"}
        speed = float(f"{speed:.1f}")
    pitch = preset.gimbal.pitch
    if dice.chance(0.15):
        rate = radians(dice.whole(30, 60))
        pitch = (radians(-90), radians(dice.whole(10, 30)))
        wanted["gimbal"] = {
            "pitch": ["-90 deg", f"{degrees(pitch[1]):.0f} deg"],
            "rate": f"{degrees(rate):.0f} deg/s",
        }
    body = preset.body
    if body == "forward" or dice.chance(0.15):
        body = dice.pick(("follow-camera", "free"))
        wanted["body"] = body
    if priority is not None:
        wanted["priority"] = priority
    return Camera(
        name,
        model,
        hfov,
        aspect,
        speed - wind,
        limits.climb,
        limits.descent,
        limits.acceleration,
        yaw_rate,
        pitch,
        rate,
        preset.radius,
        preset.endurance,
        body != "forward",
        wanted,
    )


def _lens(dice: Dice, wanted: dict[str, Any], hfov: float, aspect: float) -> tuple[float, float]:
    """Draw a lens and a frame, write them down, and return them."""
    if dice.chance(0.35):
        return hfov, aspect
    angle = dice.scaled(*LENSES_DEG, digits=0)
    lens: dict[str, Any] = {"hfov": f"{angle:g} deg"}
    if dice.chance(0.2):
        name = dice.pick(list(ASPECTS))
        lens["aspect"], aspect = name, ASPECTS[name]
    wanted["camera"] = lens
    return radians(angle), aspect
