"""Claims on what a shot promises of a target, from given samples; and promises of which there is no claim."""

from __future__ import annotations

from importlib import import_module
from math import inf, nan
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.geom.shapes import CylinderShape
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.phases import Reference
from shotc.ir.promise import Promise
from shotc.ir.target import Target
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify import promises
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.energy import energy_note
from shotc.passes.verify.promises import unjudged
from tests.support.film_plans import SPEED
from tests.support.plain_flights import WEST, plain_flight, plain_keyframe, plain_mission, plain_shot
from tests.support.records import replace

module = import_module("shotc.passes.verify.framing")
FLIGHT = plain_flight(plain_mission())
TIMES = np.array([5.0, 6.0, 7.0, 8.0])
EVERY = np.ones(len(TIMES), dtype=bool)


def sampled(promise: Promise, **seen: list[float]) -> Any:
    """Samples of four frames; seen : margins, sizes and errors in them."""
    values = {
        "margin": [0.3, 0.1, 0.2, 0.4],
        "size": [0.5, 0.4, 0.7, 0.6],
        "error": [0.01, 0.03, 0.02, 0.0],
    } | seen
    margin = np.array(values["margin"])
    frames = SimpleNamespace(margin=margin, in_frame=margin >= 0.0, size=np.array(values["size"]))
    shot = SimpleNamespace(id="out", path=("shots", 0), promise=promise)
    return module.FramingSamples(shot, "mast", TIMES, EVERY, frames, np.array(values["error"]), np.zeros(4))


@pytest.fixture
def closing(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Whether gaps between samples close, and what was asked."""
    said: dict[str, Any] = {"margins": True, "errors": True, "asked": []}

    def margins(flight: Any, target: str, times: Any) -> bool:
        said["asked"].append((target, list(times)))
        return bool(said["margins"])

    def errors(flight: Any, shot: str, target: str, times: Any, limit: float) -> bool:
        said["asked"].append((shot, target, list(times), limit))
        return bool(said["errors"])

    monkeypatch.setattr(module, "margins_close", margins)
    monkeypatch.setattr(module, "errors_close", errors)
    return said


@pytest.mark.parametrize("promised", [None, 0.5, 0.75, 1.0])
@pytest.mark.parametrize("cropped", [0, 1, 2])
def test_a_target_is_whole_in_the_promised_share_of_frames(
    promised: float | None, cropped: int, closing: dict[str, Any]
) -> None:
    margin = [-0.1 * (k < cropped) + 0.01 * k for k in range(4)]
    claim = module._in_frame(FLIGHT, sampled(Promise(in_frame=promised), margin=margin))
    share = 1.0 - cropped / 4
    assert (claim.constraint, claim.worst, claim.upper) == ("mast in frame", share, False)
    assert (claim.limit, claim.hard) == (1.0 if promised is None else promised, promised is not None)
    assert claim.holds == (share >= claim.limit)
    assert (claim.time, claim.shot) == (5.0, "out")
    assert claim.path == ("shots", 0, "require", "in_frame")[: 2 if promised is None else 4]
    assert claim.method == ("sampled" if cropped else "bounded")
    assert closing["asked"] == ([] if cropped else [("mast", TIMES.tolist())])


def test_what_is_whole_in_every_frame_is_proved_only_if_its_gaps_close(closing: dict[str, Any]) -> None:
    closing["margins"] = False
    claim = module._in_frame(FLIGHT, sampled(Promise(in_frame=1.0)))
    assert (claim.worst, claim.method, claim.time) == (1.0, "sampled", 6.0)


@pytest.mark.parametrize(
    ("promised", "closes", "method", "holds"),
    [
        (None, True, "sampled", True),
        (0.04, True, "bounded", True),
        (0.04, False, "sampled", True),
        (0.02, True, "sampled", False),
    ],
)
def test_a_screen_error_is_the_largest_and_proved_where_it_is_promised_and_kept(
    promised: float | None, closes: bool, method: str, holds: bool, closing: dict[str, Any]
) -> None:
    closing["errors"] = closes
    (claim,) = module._screen_error(FLIGHT, sampled(Promise(screen_error=promised)))
    assert (claim.constraint, claim.worst, claim.time) == ("mast screen error", 0.03, 6.0)
    assert (claim.limit, claim.upper) == (inf if promised is None else promised, True)
    assert (claim.hard, claim.method, claim.holds) == (promised is not None, method, holds)
    asks = promised is not None and holds
    assert closing["asked"] == ([("out", "mast", TIMES.tolist(), promised)] if asks else [])


def test_frames_without_a_reference_have_no_error(closing: dict[str, Any]) -> None:
    some = sampled(Promise(screen_error=0.04), error=[0.02, nan, 0.01, nan])
    (claim,) = module._screen_error(FLIGHT, some)
    assert (claim.worst, claim.time) == (0.02, 5.0)
    assert closing["asked"] == [("out", "mast", [5.0, 7.0], 0.04)]
    assert list(module._screen_error(FLIGHT, sampled(Promise(screen_error=0.04), error=[nan] * 4))) == []


@pytest.mark.parametrize(
    ("promised", "holds"),
    [
        (None, (True, True)),
        ((0.39, 0.71), (True, True)),
        ((0.41, 0.71), (False, True)),
        ((0.39, 0.69), (True, False)),
    ],
)
def test_sizes_are_held_at_both_ends(promised: tuple[float, float] | None, holds: tuple[bool, bool]) -> None:
    small, large = module._size(FLIGHT, sampled(Promise(size=promised)))
    assert (small.constraint, small.worst, small.time, small.upper) == ("mast size smallest", 0.4, 6.0, False)
    assert (large.constraint, large.worst, large.time, large.upper) == ("mast size largest", 0.7, 7.0, True)
    assert (small.holds, large.holds) == holds
    assert (small.limit, large.limit) == ((-inf, inf) if promised is None else promised)
    assert small.hard is large.hard is (promised is not None)
    assert small.unit == "of the frame"


def test_a_size_that_is_unknown_in_one_frame_breaks_both_ends() -> None:
    small, large = module._size(FLIGHT, sampled(Promise(size=(0.1, 0.9)), size=[0.5, nan, 0.6, 0.5]))
    assert (small.worst, large.worst, small.time, large.time) == (-inf, inf, 6.0, 6.0)
    assert (small.holds, large.holds) == (False, False)


PROMISES = {
    "in_frame": (1.0, "mast in frame"),
    "screen_error": (0.05, "mast screen error"),
    "size": ((0.1, 0.9), "mast size smallest"),
    "visible": (0.5, "mast visible"),
    "reveal": ((0.1, 0.9), "mast visible at first"),
}


def told(promise: Promise, *constraints: str, shot: str = "out", flown: bool = True) -> list[str]:
    base = plain_mission()
    mission = replace(base, shots=(replace(base.shots[0], id="out", promise=promise),))
    certificate: list[Claim] = [replace(SPEED, constraint=name, shot=shot) for name in constraints]
    track = FLIGHT.track if flown else replace(FLIGHT.track, phases=())
    ir = TrajectoryIR(KeyframeIR(mission, ()), (track,), (), ())
    found = list(unjudged(ir, tuple(certificate)))
    assert {d.code for d in found} <= {"V046"}
    return [d.message.split("`")[3] for d in found]


@pytest.mark.parametrize("key", PROMISES)
def test_a_promise_without_its_claim_is_told(key: str) -> None:
    value, constraint = PROMISES[key]
    promise = replace(Promise(), **{key: value})
    others = [name for of, (_, name) in PROMISES.items() if of != key and "visible" not in name]
    if "visible" in constraint:
        others = [name for name in others if "visible" not in name]
    assert told(promise, *others) == [key]
    assert told(promise, constraint) == []
    assert told(promise, constraint, shot="back") == [key]
    assert told(promise, *others, flown=False) == []
    assert told(Promise()) == []


def standing(place: np.ndarray, start: float, end: float) -> Piecewise:
    return Piecewise(np.array([start, end]), np.tile(place, (1, 2, 1)))


def test_samples_are_of_the_frames_that_show_a_target_and_of_both_ends() -> None:
    """The camera looks East along its way; the mast is ahead to the right until the camera has passed it."""
    mast = Target("mast", (20.0, -6.0, 13.0), CylinderShape(0.5, 2.0), ("targets", "mast"))
    mission = plain_mission(targets=(mast,), rate=5.0)
    place = np.array([0.3, -0.1])
    spans = [(4.1, 8.0, True), (8.5, 9.1, False), (9.3, 13.9, True)]
    framing = tuple(
        Reference("out", "mast", a, b, standing(place, a, b) if known else None) for a, b, known in spans
    )
    track = replace(FLIGHT.track, framing=framing)
    flight = JudgedFlight(mission, mission.drones[0], track)
    one = plain_shot(plain_keyframe(WEST))
    view = module.view_of(flight, one, "mast", track.phases[1])
    ticks = [t for t in np.arange(20, 71) / 5.0 if any(a <= t <= b for a, b, _ in spans)]
    assert view.times.tolist() == sorted({*ticks, *(t for a, b, _ in spans for t in (a, b))})
    half = np.tan(0.6)
    for t, error in zip(view.times, view.error, strict=True):
        ahead = 20.0 - 4.0 * (t - 4.0)
        if 8.5 <= t <= 9.1:
            assert np.isnan(error)
        elif ahead < 0:
            assert error == inf
        else:
            place_now = np.array([6.0 / (ahead * half), 3.0 / (ahead * half) * mission.drones[0].aspect])
            assert error == pytest.approx(np.linalg.norm(place_now - place))
    assert module.view_of(flight, one, "tower", track.phases[1]) is None


@pytest.mark.parametrize(
    ("small", "large", "told"),
    [(0.123, 0.5, "size: [0.123, 0.8]"), (0.5, 0.934, "size: [0.2, 0.934]"), (0.1, 1.0, "size: [0.1, 1]"),
     (0.5, 1.2, ""), (-inf, 0.9, "")],
)  # fmt: skip
def test_a_size_that_is_kept_is_told_where_it_is_one(small: float, large: float, told: str) -> None:
    shot: Any = SimpleNamespace(id="half", promise=Promise(size=(0.2, 0.8)))
    size = replace(SPEED, shot="half", constraint="mast size smallest", upper=False, unit="of the frame")
    low = replace(size, worst=small, holds=small >= 0.2)
    high = replace(size, constraint="mast size largest", upper=True, worst=large, holds=large <= 0.8)
    other = replace(low, shot="back", worst=0.05, holds=False)
    assert promises._size(shot, (low, high, other)) == told


def test_the_energy_of_a_flight_is_told_shot_by_shot() -> None:
    whole = replace(SPEED, constraint="energy", unit="Wh", worst=10.0, shot=None)
    shots = [replace(whole, shot=name, worst=wh) for name, wh in (("look", 3.0), ("rise", 2.0))]
    others = [replace(whole, subject="cam2", shot="away", worst=9.0), replace(SPEED, shot="look", worst=7.0)]
    note = energy_note(whole, (whole, *shots, *others))
    assert note == "shot `look` takes 3 Wh, shot `rise` takes 2 Wh, all else 5 Wh"
    assert energy_note(SPEED, (whole, *shots)) == ""
