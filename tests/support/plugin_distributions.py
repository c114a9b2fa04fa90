"""Distributions with a plugin, laid into a folder with the metadata that makes them found."""

from __future__ import annotations

from pathlib import Path

REFINER = """
from shotc.ir.passes import Outcome

class Made:
    name, summary, api = {name!r}, "made for a test", 1

    def refine(self, path, ctx):
{body}

PLUGIN = Made()
"""

KIND = """
from typing import Literal
from shotc.plugin_api import Expansion, Kind, ShotBase

class Shot(ShotBase):
    kind: Literal["sample"]

def expand(shot, scene):
    {body}

PLUGIN = Kind("sample", "made for a test", Shot, expand)
"""


def lay(folder: Path, distribution: str, entry: str, source: str, group: str = "emitters") -> None:
    """Lay a module, and a distribution that registers its PLUGIN under a name."""
    module = distribution.replace("-", "_")
    (folder / f"{module}.py").write_text(source)
    info = folder / f"{module}-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {distribution}\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[shotc.{group}]\n{entry} = {module}:PLUGIN\n")


def refiner(name: str, *lines: str) -> str:
    """Return the source of a refiner whose ``refine`` has these lines."""
    return REFINER.format(name=name, body="\n".join(f"        {line}" for line in lines))
