"""``shotc view``: show a plan in the rerun viewer. A mission is planned first."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated

import typer

from shotc.api import PlanOptions, compile_source, emit_plan
from shotc.cli import console
from shotc.cli.inputs import read_mission
from shotc.cli.plans import proved
from shotc.cli.refiner import with_missing
from shotc.diag.model import Diagnostic
from shotc.requirements import remedy

if TYPE_CHECKING:  # the base install has no numpy
    from shotc.ir.trajectory import VerifiedIR

What = Annotated[str, typer.Argument(metavar="SPEC|PLAN", help="A mission, a plan.json, or its folder.")]


def view(what: What) -> None:
    """Show a plan in the rerun viewer: the world, the camera's own view, the plots, on one clock.

    A mission is planned first; nothing is written. Example:

        shotc view out/tower
    """
    fault = _obstacle()
    if fault is not None:
        console.report([fault], {})
        raise typer.Exit(console.EXIT_REJECTED)
    is_plan = Path(what).is_dir() or what.lower().endswith(".json")
    plan = proved(Path(what)) if is_plan else _planned(what)
    emitted = emit_plan(plan, ["rerun"])
    recording = next((a for a in emitted.artifacts if a.name == "mission.rrd"), None)
    console.report(emitted.diagnostics, {})
    if recording is None:
        raise typer.Exit(console.EXIT_REJECTED)
    with TemporaryDirectory(prefix="shotc-") as folder:
        path = Path(folder) / recording.name
        path.write_bytes(recording.data)
        status = _show(path)
    if status:
        console.report([_failed(status)], {})
        raise typer.Exit(console.EXIT_REJECTED)


def _planned(spec: str) -> VerifiedIR:
    """Return the plan of a mission. If there is none, report why and exit."""
    source = read_mission(spec)
    options = PlanOptions(progress=console.note)
    compilation = with_missing(compile_source(source.data, source.name, source.folder, options), None)
    console.report(compilation.diagnostics, compilation.sources)
    if compilation.plan is None:
        raise typer.Exit(console.EXIT_REJECTED)
    return compilation.plan


def _show(path: Path) -> int:
    """Start a viewer, wait until it is closed, and return its exit status."""
    console.note("the viewer is open; close it to go on")
    command = [sys.executable, "-P", "-m", "rerun", "--bind", "127.0.0.1", "--port", "auto", str(path)]
    return subprocess.run(command, check=False).returncode


def _obstacle() -> Diagnostic | None:
    """Return the diagnostic of a condition that prevents a viewer from opening, or None."""
    if find_spec("rerun") is None:
        return Diagnostic(
            "E201",
            "the viewer is not installed",
            notes=("missing: rerun",),
            help=remedy(["rerun"]),
        )
    if sys.platform == "linux" and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return Diagnostic(
            "E202",
            "there is no display to show the plan on",
            notes=("neither DISPLAY nor WAYLAND_DISPLAY is set",),
            help="`shotc plan` writes mission.rrd: open it with `rerun mission.rrd` on a machine with a "
            "screen, or in a browser with `rerun --web-viewer mission.rrd`; storyboard.png needs no viewer",
        )
    return None


def _failed(status: int) -> Diagnostic:
    return Diagnostic(
        "E203",
        "the viewer failed",
        notes=(f"its exit status is {status}; what it printed stands above",),
        help="install a graphics driver (Vulkan, Metal), or use a browser: `rerun --web-viewer mission.rrd`",
    )
