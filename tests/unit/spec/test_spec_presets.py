from math import pi

import pytest

from shotc.spec import presets
from shotc.spec.drones import DroneSpec
from shotc.spec.presets import DEFAULT_MODEL, PRESETS
from shotc.spec.rules import OutputSpec, RulesSpec


@pytest.mark.parametrize("name", PRESETS)
def test_presets_are_drones_that_can_fly_and_film(name):
    preset = PRESETS[name]
    assert all(value > 0 for value in preset.limits.bounds.values())
    assert preset.limits.descent <= preset.limits.climb <= preset.limits.speed
    assert preset.limits.jerk >= preset.limits.acceleration
    assert preset.gimbal.pitch[0] < 0 < preset.gimbal.pitch[1] < pi / 2
    assert preset.gimbal.yaw[0] == -preset.gimbal.yaw[1]
    assert 0.5 < preset.hfov < 2.0
    assert 1 <= preset.aspect < 2.4
    assert 0.05 < preset.radius < 2
    assert 200 < preset.endurance < 3600
    assert preset.summary
    assert preset.source


def test_the_language_knows_the_presets():
    assert {"x500", "show-drone"} < set(PRESETS)
    assert DroneSpec.model_validate({}).model == DEFAULT_MODEL
    for name in PRESETS:
        assert DroneSpec.model_validate({"model": name}).model == name


def test_silence_means_the_defaults():
    rules = RulesSpec.model_validate({})
    assert (rules.separation, rules.ground_clearance, rules.target_clearance) == (3.0, 2.0, 1.0)
    assert (rules.pace, rules.composition.name) == (0.75, presets.COMPOSITION)
    assert OutputSpec.model_validate({}).emit is None
    assert (presets.RATE_HZ, presets.SHOW_RATE_HZ) == (50.0, 5.0)
