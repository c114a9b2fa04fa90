"""What is told of a way that passes several things too near, by the remedy of each rule."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from shotc.geom.solids import Cylinder
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import Zone
from shotc.ir.phases import Phase
from shotc.ir.trajectory import TrajectoryIR
from shotc.ir.transits import TransitInterval
from shotc.passes.verify import passing
from shotc.passes.verify.passing import PLAY_M, ClosestPass
from shotc.passes.verify.transits import ENDING, transits
from tests.support.plain_flights import RADIUS_M, plain_flight, plain_mission


def together(*passes: tuple[str, float]) -> list[tuple[Any, ClosestPass]]:
    """Claims of one drone on one way: the key of the rule, and the least distance on the way."""
    made = []
    for key, least in passes:
        claim = SimpleNamespace(subject="cam", path=("rules", "transit_clearance", key), limit=5.0)
        made.append((claim, ClosestPass("it", ("zones", "it"), ("a", "b"), 1.0, least, 5.0, least, "")))  # type: ignore[arg-type]
    return made


def test_each_rule_that_a_way_breaks_is_accepted_at_the_least_distance_of_its_passes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(passing, "_near", lambda *_: "near")
    monkeypatch.setattr(passing, "_when", lambda *_: "then")
    monkeypatch.setattr(passing, "_labels", lambda *_: ())
    passes = together(("other", 3.0), ("filmed", 2.0), ("other", 1.5), ("filmed", PLAY_M / 2))
    found = passing._diagnostic(SimpleNamespace(), passes)  # type: ignore[arg-type]
    least = passing.at_most(1.5 - PLAY_M)
    assert f"transit_clearance: {{filmed: 0.00 m, other: {least} m}}" in found.help
    assert f"give the way {2 * (5.0 - PLAY_M / 2):.2f} m more room" in found.help
    assert found.message == "cam passes near"
    assert found.notes == ("then", *["and near; then"] * 3)


def test_the_pass_that_lacks_most_is_told_first(monkeypatch: pytest.MonkeyPatch) -> None:
    way = TransitInterval(0.0, 9.0, "b")
    needs = {"mast": (9.0, 1.0), "house": (5.0, 3.0), "tree": (20.0, 2.5)}
    passes = {name: ClosestPass(name, (name,), way, 1.0, n - lack, n) for name, (n, lack) in needs.items()}
    broken = {"holds": False, "hard": False, "subject": "cam"}
    claims = tuple(SimpleNamespace(constraint=f"{name}{ENDING}", **broken) for name in needs)
    monkeypatch.setattr(passing, "_passes", lambda _, claim: [passes[claim.constraint.removesuffix(ENDING)]])
    monkeypatch.setattr(passing, "_diagnostic", lambda _, together: [one.name for _, one in together])
    (told,) = passing.reported_passes(SimpleNamespace(), claims)  # type: ignore[arg-type]
    assert told == ["house", "tree", "mast"]


@pytest.mark.parametrize(("needs", "tapers"), [(5.0, False), (4.995, False), (4.5, True)])
def test_where_a_way_begins_or_ends_nearer_less_is_needed_and_told(needs: float, tapers: bool) -> None:
    claim = SimpleNamespace(limit=5.0)
    passed = ClosestPass("it", ("zones", "it"), TransitInterval(0.0, 9.0, "b"), 1.0, 1.0, needs)
    assert ("less than 5 m" in passing._when(claim, passed)) is tapers  # type: ignore[arg-type]


@pytest.mark.parametrize("moves", [False, True])
def test_a_required_clearance_is_refused_by_the_name_of_its_setting(
    moves: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What passes may have passed at another time; what stands does not."""
    monkeypatch.setattr(passing, "_labels", lambda *_: ())
    ((claim, passed), *_) = together(("filmed", 2.0))
    claim.hard = True
    target = SimpleNamespace(path=("zones", "it"), track=object() if moves else None)
    ir: Any = SimpleNamespace(keyframes=SimpleNamespace(mission=SimpleNamespace(targets=(target,))))
    passed = passed._replace(interval=TransitInterval(0.0, 9.0, None))
    found = passing._refused(ir, claim, passed)
    assert ("at another time" in found.help) == moves
    assert found.help.startswith("lower `transit_clearance.filmed` to 1.9")
    assert "on the way home" in found.message


@pytest.mark.parametrize(
    ("closer", "first", "count"),
    [(0.5, 1, 2), (1e-4, 0, 2), (0.0, 0, 2), (-1e-4, 0, 2), (-0.5, 0, 2), (-1.5, 0, 1)],
)
def test_passes_are_told_from_the_nearest_and_equal_ones_in_time(
    closer: float, first: int, count: int
) -> None:
    """A drone passes a mast by 1.9 m, and by so much less on its way back; it is to keep 3 m."""
    mast = Zone(
        "mast", "out", Cylinder((20.0, 3.0), 3.0 - 1.9 - RADIUS_M, 0.0, 40.0), ("world", "zones", "mast")
    )
    mission = plain_mission(zones=(mast,))
    way = (
        (0.0, (0.0, 0.0, 0.0)), (4.0, (0.0, 0.0, 10.0)), (14.0, (40.0, 0.0, 10.0)),
        (15.0, (40.0, closer, 10.0)), (25.0, (0.0, closer, 10.0)),
        (26.0, (0.0, 0.0, 10.0)), (30.0, (0.0, 0.0, 0.0)),
    )  # fmt: skip
    phases = (
        Phase("takeoff", None, 0.0, 4.0), Phase("transit", None, 4.0, 14.0),
        Phase("shot", "half", 14.0, 15.0), Phase("return", None, 15.0, 26.0), Phase("land", None, 26.0, 30.0),
    )  # fmt: skip
    flight = plain_flight(mission, way, phases)
    (claim,) = transits(flight)
    ir = TrajectoryIR(KeyframeIR(mission, ()), (flight.track,), (), ())
    found = passing._passes(ir, claim)
    assert len(found) == count
    assert found[0].interval.start == (4.0, 15.0)[first]
    expected = [1.9, 1.9 - closer]
    assert [p.has for p in found] == pytest.approx([expected[p.interval.start > 9] for p in found], abs=1e-3)
    assert [p.needs for p in found] == pytest.approx([3.0] * count)
    assert all(abs(p.at - (9.0, 20.0)[p.interval.start > 9]) < 0.1 for p in found)
    assert {p.name for p in found} == {"zone `mast`"}
