"""``shotc identify``: find the targets in the mission's scene that keyframes refer to."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from shotc import plugins
from shotc.cli import console
from shotc.cli.console import known, table
from shotc.cli.inputs import STDIN, read_mission
from shotc.emit.base import Artifact
from shotc.output import write

if TYPE_CHECKING:
    from shotc.identify.mission import Identification

USUAL = "spectral-residual"

Spec = Annotated[str, typer.Argument(metavar="SPEC", help="The mission file, or - for standard input.")]
OutputFile = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--output",
        metavar="MISSION",
        help="The mission to write [NAME-identified.yaml beside SPEC].",
    ),
]
Guess = Annotated[
    bool,
    typer.Option("--guess", help="Guess a box for each keyframe that has neither a box nor a target."),
]
SaliencyName = Annotated[
    str, typer.Option("--saliency", metavar="NAME", help="What guesses; see `shotc list saliency`.")
]
Force = Annotated[bool, typer.Option("--force", help="Replace the files if they exist.")]


def identify(
    spec: Spec,
    output: OutputFile = None,
    guess: Guess = False,
    saliency: SaliencyName = USUAL,
    force: Force = False,
) -> None:
    """Find the targets that keyframes mean in the mission's scene.

    Draw `box: [u0, v0, u1, v1]` around your subject in a keyframe of a `keyframes` shot: the lower left and
    the upper right corner on the screen, u to the right and v up, from -1 to 1. Rays through the box find
    the parts of `world.scene` and `world.buildings` in it. Parts that belong together become one target, a
    cylinder. If several keyframes show the same thing, it is one target.

    The command writes the mission with the targets; comments and layout stay. Beside it, it writes a sheet of
    pictures (PNG) with boxes and cylinders: look at it. Both give the confidence of each target; less than 60
    % is a warning with the runner-up. `--guess` draws a box around what is unlike the rest of the picture.
    The guess is seldom right. The guessed box is written, too, so that you can correct it.

    Example: `shotc identify church.yaml -o church-identified.yaml`
    """
    known("--saliency", saliency, plugins.names("saliency"))
    source = read_mission(spec)
    place = output or _beside(spec, source.name)
    sheet = place.with_suffix(".png")
    for path in (place, sheet):
        if path.exists() and not force:
            raise typer.BadParameter(f"`{path}` exists; add --force to replace it", param_hint="--output")
    from shotc.identify.mission import TextLocation, identify_source
    from shotc.identify.saliency import Guesser
    from shotc.identify.sheet import SheetRow, draw_sheet

    seat = _seat(saliency) if guess else None
    guesser = None if seat is None else Guesser(seat.plugin, seat.package)
    of, to = TextLocation(source.name, source.folder), TextLocation(place.as_posix(), place.parent)
    identification = identify_source(source.data, of, to, guesser)
    if identification.text is None:
        console.report(identification.diagnostics, identification.sources)
        console.complain("nothing is written")
        raise typer.Exit(console.EXIT_REJECTED)
    rows = [
        SheetRow(t.name, t.cylinder, dict(zip(t.tasks, t.shares, strict=True)))
        for t in identification.targets
    ]
    picture = draw_sheet(identification.title, identification.tasks, identification.pictures, rows)
    _, faults = write(
        [Artifact(place.name, identification.text), Artifact(sheet.name, picture)], place.parent
    )
    console.report([*identification.diagnostics, *faults], identification.sources)
    if faults:
        raise typer.Exit(console.exit_code(faults))
    console.out("\n".join(table(_rows(identification))))
    console.out(f"wrote {place} and {sheet}")
    console.note(f"next: look at {sheet}, then shotc plan {place}")


def _beside(spec: str, name: str) -> Path:
    """Return the path for a mission if the command line gives none."""
    path = Path("mission.yaml") if spec == STDIN else Path(name)
    return path.with_name(f"{path.stem}-identified{path.suffix}")


def _seat(name: str) -> plugins.Source:
    """Return the plugin that guesses boxes. If it cannot be loaded, report why and exit."""
    source = plugins.one("saliency", name)
    if source.plugin is None:
        console.report(source.diagnostics, {})
        raise typer.Exit(console.EXIT_REJECTED)
    return source


def _rows(identification: Identification) -> list[tuple[str, ...]]:
    """Return the table of the targets that were found, one row per target."""
    rows: list[tuple[str, ...]] = [("target", "where", "sure", "keyframes")]
    for target in identification.targets:
        shares = ", ".join(f"{100 * share:.0f} %" for share in target.shares)
        where = "; ".join(identification.tasks[i].label for i in target.tasks)
        rows.append((target.name, target.cylinder.described, shares, where))
    return rows
