"""What verification says of flights, word for word: the file's line, the limit's, where, and what helps."""

from __future__ import annotations

from shotc.diag.render.text import render
from shotc.flightfiles.verify import FlightsReport
from tests.experiments.planted import cruise, table
from tests.support.flight_files import (
    AROUND,
    TWO,
    kmz,
    litchi_file,
    mark,
    plan_file,
    qgc_item,
    verified,
    wpml_text,
)


def said(report: FlightsReport) -> str:
    return render(report.diagnostics, report.sources, color=False)


def test_a_leg_into_a_house() -> None:
    into = ((0.0, -60.0, 8.0), (3.3, -1.1, 8.0), (60.0, -60.0, 8.0))
    told = said(verified(("cam1.csv", litchi_file(into))))
    assert (
        told
        == """\
error[V007]: cam1: the distance of the body from zone hut is -2.416 m, at least 0 m is needed
 --> cam1.csv:3:1
  |
3 | 47.376890107,8.541743694,8.00,0,0.0,2,-10,0,5.0
  | ^^^^^^^^^^^^ on the way to waypoint 2
 ::: mission.yaml:6:5
  |
6 |     hut: {keep: out, box: {center: [0, 0, 5], size: [10, 10, 10]}}
  |     ^^^ at least 0 m
  |
  = note: worst at (3.18, -3.18, 8.00) m
  = note: 14.0 s from take-off at the file's speeds
  = note: proved between the file's places, too
  = help: keep 2.416 m farther away there

1 error found
"""
    )


def test_rows_that_are_too_fast() -> None:
    flight = cruise((0.0, -60.0, 0.0), 20.0, 9.0, 1.0)
    assert (
        said(verified(("all.csv", table({"cam1": flight}))))
        == """\
error[V001]: cam1: speed is 9 m/s, at most 8 m/s is allowed
  --> all.csv:43:1
   |
43 | 10.25,cam1,1.125,-60,20,9,0,0
   | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ up to this row
  ::: mission.yaml:8:58
   |
 8 |   cam1: {model: x500, home: [0, -60, 0], limits: {speed: 8 m/s, climb: 3 m/s, descent: 2 m/s}}
   |                                                          ^^^^^ at most 8 m/s
   |
   = note: worst at (1.12, -60.00, 20.00) m
   = note: at t = 10.250 s
   = note: proved between the file's places, too
   = help: fly slower there, by 1 m/s at least, or raise the limit

error[V002]: cam1: acceleration is 36 m/s^2, at most 3 m/s^2 is allowed
  --> all.csv:43:1
   |
43 | 10.25,cam1,1.125,-60,20,9,0,0
   | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ up to this row
  ::: mission.yaml:8:42
   |
 8 |   cam1: {model: x500, home: [0, -60, 0], limits: {speed: 8 m/s, climb: 3 m/s, descent: 2 m/s}}
   |                                          ^^^^^^ at most 3 m/s^2
   |
   = note: worst at (1.12, -60.00, 20.00) m
   = note: at t = 10.250 s
   = note: proved between the file's places, too
   = help: change speed more gently there, by 33 m/s^2 at least

2 errors found
"""
    )


def test_a_file_of_nobody_and_one_of_two_levels() -> None:
    mixed = plan_file((), items=[qgc_item(AROUND[0]), qgc_item(AROUND[1], frame=0)])
    assert (
        said(verified(("cam1.plan", mixed), text=TWO))
        == """\
error[I011]: `cam1.plan` cannot be judged: item 2 counts its height from sea level, item 1 from the take-off
  --> cam1.plan:24:4
   |
24 |    {
   |    ^
   |
   = help: let all waypoints count from one level: how they fit is known at take-off only

1 error found
"""
    )
    assert (
        said(verified(("b.kmz", kmz(wpml_text([mark(p) for p in AROUND]))), text=TWO))
        == """\
error[I013]: `b.kmz` is named after no drone of the mission
 --> b.kmz:1:1
  |
  = note: its drones are `cam1`, `cam2`
  = help: name each file after its drone, as `cam1.kmz`, or say whose it is with `--drone NAME`

1 error found
"""
    )
