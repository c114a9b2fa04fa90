"""The page on the output files names all that stands in them."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import fields
from pathlib import Path
from typing import Any, get_args

import pytest

import shotc
from shotc.emit.csv_table import EFFORT, FRAMING, GEODETIC, LIGHT, TRAJECTORY
from shotc.emit.ned import SETPOINTS
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.keyframes import PlacedKeyframe, PlacedSubject
from shotc.ir.measures import OUT_OF_PICTURE
from shotc.ir.mission import ELSEWHERE_IN_PLANS, MissionIR
from shotc.ir.path import ClockDeviation, PathDeviation
from shotc.ir.phases import Reference
from shotc.ir.text import field_names
from shotc.ir.trajectory import Claim, DroneTrajectory
from shotc.passes.verify.report import ENDING, RULES, SOFT, STARTING
from shotc.planfile.codec import hints
from shotc.planfile.write import document
from shotc.simulation.clearance import ClosestApproach
from shotc.simulation.conditions import Conditions
from shotc.simulation.document import FLIGHT, json_text
from shotc.simulation.fleets.near import ClosestPair
from shotc.simulation.fleets.rehearse import FleetRehearsal
from shotc.simulation.judge import TargetFraming, TrackingError
from shotc.simulation.rehearsal import rehearse
from shotc.simulation.replans import Replans
from shotc.simulation.runs import simulated
from shotc.simulation.sensors import Detector, Gps
from shotc.simulation.shows import FleetCourse, FleetPair
from shotc.simulation.truth import Truth
from shotc.simulation.verdict import RequirementVerdict
from shotc.simulation.wind import WindField
from tests.support.film_plans import orbit_plan

PAGE = (Path(shotc.__file__).parent / "docs" / "outputs.md").read_text(encoding="utf-8")
NAMED = set(re.findall(r"`([^`]+)`", re.sub(r"```.*?```", "", PAGE, flags=re.DOTALL)))
BOLD = set(re.findall(r"\*\*(\w+)\*\*", PAGE))
RECORDS = (
    Claim,
    DroneTrajectory,
    Reference,
    PathDeviation,
    ClockDeviation,
    PlacedKeyframe,
    PlacedSubject,
    FleetTrajectory,
)
OF_PLANS = PAGE.split("\n## plan.json\n")[1]
TICKED = set(re.findall(r"`([^`]+)`", OF_PLANS))
WRITTEN_OTHERWISE = {"source_sha256", "ctrl"}
"""Fields under another name in a plan: ``source.sha256`` and the ``control`` of a curve."""
KEYS_BESIDE_RECORDS = {"mission_sha256", "transit_clearance"}
"""A key of the document itself, and one of the mission's text."""


def records_of(*kinds: Any) -> Iterator[tuple[str, str]]:
    """Yield every record that a plan may hold below these, with each of its fields that a plan stores."""
    found, rest = set(), list(kinds)
    while rest:
        kind = rest.pop()
        rest += get_args(kind)
        if kind in found or not (isinstance(kind, type) and field_names(kind)):
            continue
        found.add(kind)
        for name, held in hints(kind).items():
            if not (kind is MissionIR and name in ELSEWHERE_IN_PLANS):
                yield kind.__name__, name
                rest.append(held)


def claims_explained() -> Iterator[str]:
    """Yield the names of the table of claims."""
    table = OF_PLANS.partition("What the claims measure:")[2].partition("\n\n**")[0]
    for row in re.findall(r"^\| (`.*?) \|", table, flags=re.MULTILINE):
        yield from re.findall(r"`([^`]+)`", row)


def test_every_field_of_every_record_of_a_plan_is_explained():
    parts = set(records_of(MissionIR, *RECORDS))
    assert ("TransitClearance", "filmed_required") in parts
    assert {(of, name) for of, name in parts if name not in TICKED | WRITTEN_OTHERWISE} == set()


def test_no_field_is_explained_that_no_plan_holds():
    held = {name for _, name in records_of(MissionIR, *RECORDS)} | KEYS_BESIDE_RECORDS
    assert {name for name in TICKED if re.fullmatch("[a-z]+(_[a-z0-9]+)+", name)} - held == set()


def test_every_claim_is_explained():
    explained = list(claims_explained())
    assert [name for name in RULES if not {name, re.sub("(pitch|yaw) .*", "...", name)} & {*explained}] == []
    assert [start for start in STARTING if not any(name.startswith(start) for name in explained)] == []
    ends = (*ENDING, *SOFT, OUT_OF_PICTURE)
    assert [end for end in ends if not any(name.endswith(end) for name in explained)] == []


def test_no_claim_is_explained_that_no_verdict_has():
    plain = [name for name in claims_explained() if not re.search("[A-Z]|[.]", name)]
    assert len(plain) > 30
    assert [name for name in plain if name not in RULES and not name.startswith(tuple(STARTING))] == []


def test_every_column_of_the_tables_is_explained():
    columns = f"{TRAJECTORY}{GEODETIC}{LIGHT}{EFFORT},{FRAMING},{FLIGHT},{SETPOINTS}".split(",")
    assert [column for column in columns if column not in NAMED] == []


def test_every_part_of_a_plan_is_explained():
    parts = [*document(orbit_plan()), *field_names(MissionIR)]
    elsewhere = {*ELSEWHERE_IN_PLANS, "source_sha256"}
    assert [part for part in parts if part not in NAMED and part not in elsewhere] == []


def test_every_field_of_what_a_plan_holds_is_explained():
    fields = [name for record in RECORDS for name in field_names(record)]
    assert [name for name in fields if name not in NAMED] == []


@pytest.mark.long
def test_every_part_of_simulate_json_is_explained():
    ir, conditions = orbit_plan().trajectory, Conditions()
    done = rehearse(ir, conditions, simulated(ir, conditions, 1, 1), lambda _runs: None)
    run = json.loads(json_text(done))
    of_fleets = (ClosestPair, FleetRehearsal, FleetCourse, FleetPair)
    records = (
        TrackingError,
        TargetFraming,
        RequirementVerdict,
        Replans,
        *of_fleets,
        WindField,
        Gps,
        Detector,
        Truth,
    )
    named = [field.name for record in records for field in fields(record)]
    parts = [*run, *run["conditions"], *run["asked"], *run["runs"][0], *ClosestApproach._fields, *named]
    assert [part for part in parts if part not in NAMED | BOLD] == []
