"""The files of a comparison: JSON, a table in Markdown, pictures and a recording."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec

from shotc import plugins
from shotc.comparison.document import json_text
from shotc.comparison.table import markdown
from shotc.emit.base import Artifact, Emission
from shotc.emit.storyboard.differing import draw_differences
from shotc.emit.storyboard.side_by_side import draw_comparison
from shotc.ir.comparison import Comparison

DPI = 110.0


def artifacts(comparison: Comparison, progress: Callable[[str], None]) -> Emission:
    """Return compare.json, compare.md, compare.png, differences.png and compare.rrd.

    All but the recording are reproducible. differences.png exists if two conditions have a plan. The
    recording is left out with a warning if rerun is not installed.
    """
    files = [
        Artifact("compare.json", json_text(comparison, seconds=False).encode("ascii")),
        Artifact("compare.md", markdown(comparison, seconds=False).encode("utf-8")),
    ]
    progress("drawing compare.png")
    files.append(Artifact("compare.png", draw_comparison(comparison, DPI)))
    if comparison.differences:
        progress("drawing differences.png")
        files.append(Artifact("differences.png", draw_differences(comparison, DPI)))
    if find_spec("rerun") is None:
        return Emission(tuple(files), (plugins.not_installed("P005", "output `compare.rrd`", ["rerun"]),))
    from shotc.emit.rerun_log.side_by_side import record_comparison

    progress("recording compare.rrd")
    files.append(Artifact("compare.rrd", record_comparison(comparison, markdown(comparison, seconds=False))))
    return Emission(tuple(files))
