from types import SimpleNamespace

import numpy as np
import pytest

from shotc.geom.bernstein import quintic_hermite
from shotc.plugin_api.replanner import Plan
from shotc.simulation.sent import Fading, Sent, SentPlans
from shotc.simulation.vehicle import VehicleSetpoint


class _Film:
    """A drone that goes East at 2 m/s."""

    times = np.arange(0, 20, 0.01)

    class track:
        curve = quintic_hermite(
            np.array([0.0, 20.0]),
            np.array([[0.0, 0, 5], [40.0, 0, 5]]),
            np.array([[2.0, 0, 0]] * 2),
            np.zeros((2, 3)),
        )

    def step(self, time):
        return round(time / 0.01)

    def setpoint(self, k):
        t = self.times[k]
        return VehicleSetpoint(np.array([[2.0 * t, 0, 5]]), np.array([[2.0, 0, 0]]), np.zeros((1, 3)))


def plan(start=1.0, n=20, velocity=(1.0, 0.5, 0.0), acceleration=(0.2, -0.1, 0.0)):
    t = 0.1 * np.arange(n + 1)[:, None]
    v, a = np.array(velocity), np.array(acceleration)
    return Plan(start + t[:, 0], v * t + 0.5 * a * t * t, v + a * t, np.tile(a, (n, 1)))


def test_a_plan_is_flown_between_its_stages_as_it_says():
    held = SentPlans((plan(), plan(velocity=(0.0, 1.0, 0.0))), 3.0)
    now = held.setpoint(1.77)
    assert now.position[0] == pytest.approx([0.77 + 0.1 * 0.77**2, 0.385 - 0.05 * 0.77**2, 0.0])
    assert now.velocity[0] == pytest.approx([1 + 0.2 * 0.77, 0.5 - 0.1 * 0.77, 0.0])
    assert now.acceleration[1] == pytest.approx([0.2, -0.1, 0.0])


def test_past_its_end_a_drone_brakes_at_the_limit_and_holds():
    held = SentPlans((plan(acceleration=(0, 0, 0), velocity=(3.0, 0.0, 0.0)),), 2.0)
    braking, stopped, later = (held.setpoint(3.0 + t) for t in (0.5, 1.5, 9.0))
    assert braking.acceleration[0] == pytest.approx([-2.0, 0.0, 0.0])
    assert braking.velocity[0] == pytest.approx([2.0, 0.0, 0.0])
    assert braking.position[0] == pytest.approx([6.0 + 1.5 - 0.25, 0.0, 0.0])
    assert stopped.position[0] == pytest.approx([6.0 + 9.0 / 4.0, 0.0, 0.0])
    assert later.position == pytest.approx(stopped.position)
    assert not later.velocity.any()
    assert not later.acceleration.any()


def test_where_a_plan_fails_the_last_one_is_kept():
    first, new = plan(), plan(start=1.5)
    assert SentPlans((first, first), 3.0).replaced([None, new]).plans == (first, new)


def test_the_way_back_to_the_plan_leads_smoothly_from_one_to_the_other():
    off, rate = np.array([[3.0, -2.0, 1.0]]), np.array([[0.5, 0.0, -0.2]])
    film = _Film()
    back = Fading.none(film, 1).begun(0, 2.0, 4.0, (off[0], rate[0]))
    begins, ends = back.setpoint(2.0), back.setpoint(6.0)
    assert begins.position - film.setpoint(200).position == pytest.approx(off)
    assert begins.velocity - film.setpoint(200).velocity == pytest.approx(rate)
    for name in ("position", "velocity", "acceleration"):
        assert getattr(ends, name) == pytest.approx(getattr(film.setpoint(600), name), abs=1e-9)
    for at in (2.5, 3.7, 5.2):
        before, now, after = (back.setpoint(at + s * 0.01) for s in (-1, 0, 1))
        assert (after.position - before.position) / 0.02 == pytest.approx(now.velocity, abs=1e-3)
        assert (after.velocity - before.velocity) / 0.02 == pytest.approx(now.acceleration, abs=1e-2)


def test_others_know_a_plan_once_it_is_old_enough_and_the_mission_before():
    sent = Sent(_Film(), age=0.5)
    sent.add(1.0, (plan(),))
    stages = 1.2 + 0.1 * np.arange(5)
    planned = np.column_stack([2.0 * stages, 0 * stages, 0 * stages + 5.0])
    assert sent.places(0, stages) == pytest.approx(planned)
    later = 1.5 + 0.1 * np.arange(30)
    known = sent.places(0, later)
    t = later[:10] - 1.0
    assert known[:10, 0] == pytest.approx(t + 0.1 * t * t)
    # Beyond its end the mission's plan is all that is known.
    assert known[-1] == pytest.approx([2.0 * later[-1], 0.0, 5.0])


def test_who_sends_no_new_plan_brakes_and_holds_and_who_is_back_flies_as_planned():
    film = _Film()
    film.drone = SimpleNamespace(limits=SimpleNamespace(usable_acceleration=2.0))
    sent = Sent(film, age=0.5)
    sent.add(1.0, (plan(velocity=(3.0, 0.0, 0.0), acceleration=(0.0, 0.0, 0.0)),))
    stages = 4.0 + 0.1 * np.arange(20)
    held = sent.places(0, stages)
    assert held[0] == pytest.approx([6.0 + 3.0 - 1.0, 0.0, 0.0])  # it has braked for 1 s
    assert held[-1] == pytest.approx([6.0 + 9.0 / 4.0, 0.0, 0.0])
    sent.add(4.0, (None,))
    later = 4.5 + 0.1 * np.arange(5)
    assert sent.places(0, later)[:, 0] == pytest.approx(2.0 * later)
