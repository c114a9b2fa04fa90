"""Shots for the refiners of `plugins/shotc-casadi`: in memory for their parts, as text for the whole."""

from __future__ import annotations

from shotc_casadi import conditions
from shotc_casadi.conditions import Condition
from shotc_casadi.problem import Margins, problem
from shotc_casadi.program import Problem
from shotc_casadi.refiner import subjects
from shotc_casadi.stages import stages
from shotc_casadi.walls import half_spaces
from shotc_casadi.wishes import Subject, wishes

from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR
from tests.path_scenes import planned


def subject(made: MissionIR, shot: PlacedShot) -> Subject:
    """The one moving shot of a mission, on its convex path."""
    return subjects(planned(made, shot))[0]


def task(
    of: Subject,
    condition: Condition = conditions.OURS,
    count: int | None = 24,
    margins: Margins = Margins(),  # noqa: B008
) -> Problem:
    """The optimal-control problem of a shot on few stages."""
    nodes = stages(of.leg, of.placed, of.drone, count)
    walls = half_spaces(of.room, of.leg.curve, nodes)
    return problem(of, condition, nodes, wishes(of, condition, nodes.s), walls, margins)
