"""The page on the output files names all that stands in them."""

from __future__ import annotations

import json
import re
from dataclasses import fields
from pathlib import Path

import pytest

import shotc
from shotc.emit.csv_table import EFFORT, FRAMING, GEODETIC, LIGHT, TRAJECTORY
from shotc.emit.ned import SETPOINTS
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.keyframes import PlacedKeyframe, PlacedSubject
from shotc.ir.mission import ELSEWHERE_IN_PLANS, MissionIR
from shotc.ir.path import ClockDeviation, PathDeviation
from shotc.ir.phases import Reference
from shotc.ir.records import field_names
from shotc.ir.trajectory import Claim, DroneTrajectory
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
