"""``shotc new``: start a mission from a template."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from importlib.resources import files
from pathlib import Path
from typing import Annotated

import typer

from shotc.cli import console
from shotc.emit.base import Artifact
from shotc.output import write

_SUFFIX = ".yaml"

Template = Annotated[
    str | None, typer.Argument(metavar="TEMPLATE", help="The template; without one, all are listed.")
]
OutputFile = Annotated[
    Path | None,
    typer.Option(
        "-o", "--output", metavar="FILE", help="The file to write [default: TEMPLATE.yaml]; - prints."
    ),
]
Force = Annotated[bool, typer.Option("--force", help="Replace the file if it exists.")]


def new(template: Template = None, output: OutputFile = None, force: Force = False) -> None:
    """Start a mission from a template.

    Example: `shotc new landmark -o tower.yaml`
    """
    templates = _templates()
    if template is None:
        console.out(_listing(templates))
        return
    name = template.removesuffix(_SUFFIX)
    if name not in templates:
        near = get_close_matches(name, templates, n=1)
        hint = f"did you mean `{near[0]}`?" if near else f"there are: {', '.join(templates)}"
        raise typer.BadParameter(f"`{template}` is no template; {hint}", param_hint="TEMPLATE")
    if output == Path("-"):
        console.out(templates[name].decode())
        return
    _save(templates[name], output or Path(name + _SUFFIX), force=force)


def _save(data: bytes, path: Path, *, force: bool) -> None:
    """Write a new file and print the next step. Do not overwrite a file unless ``force`` is set."""
    if path.exists() and not force:
        raise typer.BadParameter(f"`{path}` exists; add --force to replace it", param_hint="--output")
    _, faults = write([Artifact(path.name, data)], path.parent)
    if faults:
        console.report(faults, {})
        raise typer.Exit(console.exit_code(faults))
    console.out(f"wrote {path}")
    console.note(f"next: shotc check {path}, then shotc plan {path}")


def _templates() -> Mapping[str, bytes]:
    """Return the templates that come with shotc, by name."""
    folder = files("shotc") / "templates"
    entries = sorted(folder.iterdir(), key=lambda entry: entry.name) if folder.is_dir() else []
    return {e.name.removesuffix(_SUFFIX): e.read_bytes() for e in entries if e.name.endswith(_SUFFIX)}


def _listing(templates: Mapping[str, bytes]) -> str:
    """Return the list of templates, each with its first comment."""
    width = max(map(len, templates), default=0)
    return "\n".join(f"{name:<{width}}  {_summary(data)}".rstrip() for name, data in templates.items())


def _summary(data: bytes) -> str:
    comments = (line.lstrip("# ") for line in data.decode().splitlines() if line.startswith("#"))
    return next((line for line in comments if line and not line.startswith("yaml-language-server")), "")
