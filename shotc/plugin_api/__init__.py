"""All that a plugin imports. Names load when they are used, so a kind needs no numpy.

A plugin is an installable package with an entry point in one of three groups, each naming an object
that carries ``name``, ``summary`` and ``api = 1``:

- ``shotc.kinds``: a ``Kind``, which turns a shot's parameters into keyframes
- ``shotc.refiners``: a ``Refiner``, which improves the filmed legs of a path
- ``shotc.emitters``: an ``Emitter``, which turns a verified plan into files
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from shotc.diag.model import Diagnostic, Label
    from shotc.emit.base import Artifact, Emission, Emitter
    from shotc.geom.bernstein import Piecewise
    from shotc.ir.keyframes import KeyframeIR
    from shotc.ir.mission import Keyframe, MissionIR
    from shotc.ir.passes import Outcome, PassContext, Refiner
    from shotc.ir.path import DronePath, Leg, PathIR
    from shotc.ir.trajectory import DroneTrajectory, TrajectoryIR, VerifiedIR
    from shotc.kinds.base import Expansion, Kind, Scene
    from shotc.passes.solver_reports import (
        SolverState,
        fallback,
        impossible,
        solver_nan,
        stopped_early,
        unrefined,
    )
    from shotc.spec.shot import ShotBase

_HOMES = {
    "Artifact": "shotc.emit.base",
    "Diagnostic": "shotc.diag.model",
    "DronePath": "shotc.ir.path",
    "DroneTrajectory": "shotc.ir.trajectory",
    "Emission": "shotc.emit.base",
    "Emitter": "shotc.emit.base",
    "Expansion": "shotc.kinds.base",
    "Keyframe": "shotc.ir.mission",
    "KeyframeIR": "shotc.ir.keyframes",
    "Kind": "shotc.kinds.base",
    "Label": "shotc.diag.model",
    "Leg": "shotc.ir.path",
    "MissionIR": "shotc.ir.mission",
    "Outcome": "shotc.ir.passes",
    "PassContext": "shotc.ir.passes",
    "PathIR": "shotc.ir.path",
    "Piecewise": "shotc.geom.bernstein",
    "Refiner": "shotc.ir.passes",
    "Scene": "shotc.kinds.base",
    "ShotBase": "shotc.spec.shot",
    "SolverState": "shotc.passes.solver_reports",
    "TrajectoryIR": "shotc.ir.trajectory",
    "VerifiedIR": "shotc.ir.trajectory",
    "fallback": "shotc.passes.solver_reports",
    "impossible": "shotc.passes.solver_reports",
    "solver_nan": "shotc.passes.solver_reports",
    "stopped_early": "shotc.passes.solver_reports",
    "unrefined": "shotc.passes.solver_reports",
}

__all__ = [
    "Artifact",
    "Diagnostic",
    "DronePath",
    "DroneTrajectory",
    "Emission",
    "Emitter",
    "Expansion",
    "Keyframe",
    "KeyframeIR",
    "Kind",
    "Label",
    "Leg",
    "MissionIR",
    "Outcome",
    "PassContext",
    "PathIR",
    "Piecewise",
    "Refiner",
    "Scene",
    "ShotBase",
    "SolverState",
    "TrajectoryIR",
    "VerifiedIR",
    "fallback",
    "impossible",
    "solver_nan",
    "stopped_early",
    "unrefined",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
