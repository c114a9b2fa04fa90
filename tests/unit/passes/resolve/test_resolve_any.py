"""Missions of every sort, sensible or not, are placed or refused with diagnostics; nothing is raised."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.diag.registry import registry, stops
from tests.support.front_passes import KINDS, placed

lengths = st.one_of(st.integers(5, 60), st.integers(5, 60), st.sampled_from([0, -3, 1e-4, 0.5, 1e5, -1e5]))
points = st.one_of(
    st.tuples(lengths, lengths, lengths).map(list),
    st.sampled_from([[0, 0, 12], [0, -50, 12], {"lat": 47.3769, "lon": 8.5417, "height": 30}]),
)
angles = st.integers(-400, 400).map(lambda d: f"{d} deg")
pitches = st.integers(-90, 90).map(lambda d: f"{d} deg")
names = st.sampled_from(["tower", "pole", "tower", "pole", "tower", "runner", "towr"])
spans = st.one_of(lengths, st.tuples(lengths, lengths).map(list))
looks = st.one_of(names, points)
seconds = st.sampled_from([0, 0.5, 3, 20, 1e5])


def some(**fields: Any) -> st.SearchStrategy[dict[str, Any]]:
    return st.fixed_dictionaries({}, optional=fields)


aims = st.one_of(
    st.fixed_dictionaries({"look_at": looks}), st.fixed_dictionaries({"heading": angles, "pitch": pitches})
)
frames = st.sampled_from(["keep", "center", "left-third", "thirds-lines", [0.9, -0.9]])
poses = st.builds(
    lambda at, aim, more: {"at": at, **aim, **more},
    points,
    aims,
    some(frame=frames, hfov=st.sampled_from(["1 deg", "60 deg", "170 deg"]), hold=seconds, time=seconds),
)
parameters: dict[str, st.SearchStrategy[dict[str, Any]]] = {
    "keyframes": st.fixed_dictionaries({"keyframes": st.lists(poses, min_size=2, max_size=4)}),
    "static": st.builds(lambda at, aim: {"at": at, **aim}, points, aims),
    "orbit": st.fixed_dictionaries({"radius": lengths, "altitude": lengths}, optional={"sweep": angles}),
    "spiral": st.fixed_dictionaries({"radius": spans, "altitude": spans}, optional={"sweep": angles}),
    "elevator": st.fixed_dictionaries({"azimuth": angles, "distance": lengths, "altitude": spans}),
    "dolly": st.fixed_dictionaries({"azimuth": angles, "distance": spans, "altitude": lengths}),
    "dolly-zoom": st.fixed_dictionaries(
        {"azimuth": angles, "distance": spans, "altitude": lengths}, optional={"hfov": st.just("40 deg")}
    ),
    "crane": st.fixed_dictionaries({"azimuth": angles, "distance": spans, "altitude": spans}),
    "top-down": st.fixed_dictionaries({"altitude": lengths}, optional={"drift": points}),
    "follow-path": st.fixed_dictionaries(
        {"points": st.lists(points, min_size=2, max_size=4)},
        optional={"look_at": looks},
    ),
    "chase": st.fixed_dictionaries({"distance": lengths, "altitude": lengths}),
    "framing": st.fixed_dictionaries(
        {"subjects": st.lists(st.fixed_dictionaries({"target": names}), min_size=1)}
    ),
}
FIELD = [[-200, -200], [200, -200], [200, 200], [-200, 200]]
timings = some(start=seconds, duration=seconds, after=st.sampled_from(["s0", "s1", "s2", "s9"]))
compositions = st.sampled_from(["thirds", "thirds-lines", "keep", "phi", [[1, 1]]])
shots = st.sampled_from(sorted(parameters)).flatmap(
    lambda kind: st.builds(
        lambda own, more: {"kind": kind, **own, **more},
        parameters[kind],
        some(target=names, timing=timings, composition=compositions),
    )
)


@pytest.mark.long
@settings(max_examples=150, deadline=None)
@given(
    st.lists(shots, min_size=1, max_size=3),
    st.sampled_from([0, 0, 3, 3, 7.95, 20]),
    st.one_of(st.just([0, -60, 0]), points),
    st.sampled_from([True, True, False]),
    st.one_of(st.just(FIELD), st.lists(st.tuples(lengths, lengths).map(list), min_size=3, max_size=6)),
)
def test_any_mission_is_placed_or_refused(
    films: list[dict[str, Any]], wind: float, home: Any, origin: bool, corners: list[list[float]]
) -> None:
    mission = {
        "shotc": 1,
        "mission": "any",
        "world": {
            "wind": wind,
            "zones": {
                "tree": {"cylinder": {"center": [-30, 20], "radius": 3, "height": [0, 12]}},
                "lot": {"keep": "in", "polygon": {"points": corners, "height": [0, 60]}},
            },
        },
        "targets": {
            "tower": {"at": [0, 0, 12], "radius": 4, "height": 24},
            "pole": {"at": [0, -50, 12], "radius": 1e-4, "height": 1e-4},
            "runner": {"track": {"start": [0, 0, 1], "velocity": [1, 0, 0]}, "radius": 1, "height": 2},
        },
        "drones": {"cam1": {"home": home}},
        "shots": [{"id": f"s{i}", "drone": "cam1", **shot} for i, shot in enumerate(films)],
    }
    if origin:
        mission["world"]["origin"] = {"lat": 47.3769, "lon": 8.5417}  # type: ignore[index]
    value, found = placed(json.dumps(mission, indent=1))
    assert (value is None) == stops(found)
    assert all(d.code in registry() and d.labels for d in found)
    assert len(found) == len(set(found))


def test_every_kind_is_known_to_these_tests() -> None:
    assert set(parameters) | {"lead", "lateral", "flyby", "display"} == set(KINDS)
