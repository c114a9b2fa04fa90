"""Adds to a mission's text the targets that its keyframes mean."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from shotc import plugins
from shotc.checking import check_source, models_of
from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.geom.bernstein import Array
from shotc.geom.camera import ScreenBox
from shotc.identify.cylinders import Upright
from shotc.identify.find import SearchResult, find
from shotc.identify.pictures import picture
from shotc.identify.rewrite import Named, NotEditable, rewritten
from shotc.identify.saliency import Guesser
from shotc.identify.tasks import (
    SearchTask,
    doubts,
    empty,
    nothing_to_do,
    swallowed,
    tasks,
    unguessed,
)
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.ir.passes import PassContext
from shotc.pipeline import ASSIGN, FRONT, PassSettings, passes_of, run
from shotc.source.file import SourceFile
from shotc.spec.load import load

NOT_IN_NAMES = re.compile(r"[^A-Za-z0-9_-]+")
LONGEST_NAME_CHARACTERS = 60
"""Characters of a target's name, which leave room for a number behind it."""


class Identified(NamedTuple):
    """An identified target.

    tasks : numbers of the keyframes that mean it
    shares : its share of the content of each keyframe's box, 0 to 1
    """

    name: str
    cylinder: Upright
    tasks: tuple[int, ...]
    shares: tuple[float, ...]


class Identification(NamedTuple):
    """The result for a mission.

    text : the mission with its targets; None if there is an error
    tasks, pictures : the examined keyframes, and their cameras' pictures
    sources : the files that the diagnostics refer to, by name
    title : name of the mission, empty if it is not known
    """

    text: bytes | None
    targets: tuple[Identified, ...]
    tasks: tuple[SearchTask, ...]
    pictures: tuple[Array, ...]
    diagnostics: tuple[Diagnostic, ...]
    sources: dict[str, SourceFile]
    title: str = ""


class TextLocation(NamedTuple):
    """The source or destination of a text: its name, and the folder of the files that it names."""

    name: str
    folder: Path | None


def identify_source(
    data: bytes, of: TextLocation, to: TextLocation, saliency: Guesser | None
) -> Identification:
    """Return a mission with the targets that its keyframes mean.

    of, to : locations of the mission and of the result, which must pass the checks there
    saliency : guesses the boxes of keyframes without one; None ignores those keyframes
    """
    kinds = plugins.shot_kinds()
    loaded = load(data, of.name, of.folder, models_of(kinds.plugins), kinds.unusable)
    stopped = Identification(None, (), (), (), loaded.diagnostics, {of.name: loaded.file})
    if loaded.mission is None:
        return stopped
    setting = PassSettings(kinds.plugins, plugins.names("emitters"))
    front = run(passes_of((ASSIGN, *FRONT), setting), loaded.mission, PassContext())
    if not isinstance(front.value, KeyframeIR) or has_errors(front.diagnostics):
        return stopped._replace(diagnostics=(*loaded.diagnostics, *front.diagnostics))
    mission = front.value.mission
    stopped = stopped._replace(title=mission.name)
    searches = tasks(mission, guess=saliency is not None)
    wrong = nothing_to_do(mission, searches)
    if wrong is not None:
        return stopped._replace(diagnostics=(wrong,))
    pictures = tuple(picture(mission, task.camera) for task in searches)
    searches, faults = _with_boxes(mission, searches, pictures, saliency)
    if faults:
        return stopped._replace(diagnostics=tuple(faults))
    result = find(mission, [task.glance for task in searches])
    faults = [*empty(mission, result, searches), *swallowed(mission, result, searches)]
    if faults:
        return stopped._replace(diagnostics=tuple(faults))
    identification = stopped._replace(tasks=searches, pictures=pictures)
    return _written(identification, mission, result, (data, to))


def _with_boxes(
    mission: MissionIR, searches: Sequence[SearchTask], pictures: Sequence[Array], saliency: Guesser | None
) -> tuple[tuple[SearchTask, ...], list[Diagnostic]]:
    """Return keyframes with guessed boxes, or faults on those without a guess."""
    out, faults = [], []
    for task, seen in zip(searches, pictures, strict=True):
        if task.box is None and saliency is not None:
            box = saliency.box(seen)
            if not isinstance(box, ScreenBox):
                faults.append(box or unguessed(mission, task))
                continue
            task = task._replace(box=box)  # noqa: PLW2901
        out.append(task)
    return tuple(out), faults


def _written(
    identification: Identification, mission: MissionIR, result: SearchResult, text: tuple[bytes, TextLocation]
) -> Identification:
    """Return the mission with the found targets, if it passes the checks."""
    data, to = text
    names = _names(mission, result)
    cylinders = {name: target.cylinder for name, target in zip(names, result.targets, strict=True)}
    called = {i: name for name, target in zip(names, result.targets, strict=True) for i in target.glances}
    named = [
        Named(task.keyframe.path, called[i], task.box if task.guessed else None)
        for i, task in enumerate(identification.tasks)
    ]
    doubtful = tuple(doubts(mission, result, identification.tasks, names))
    try:
        new_text = rewritten(data, mission.origins.file, cylinders, named)
    except NotEditable as layout:
        label = mission.origins.value(layout.path)
        help_ = "write it out where it stands, without an anchor or alias"
        fault = Diagnostic(
            "N017", "no key can be added to what is written elsewhere, too", (label,), help=help_
        )
        return identification._replace(diagnostics=(fault,))
    checked = check_source(new_text, to.name, to.folder)
    sources = {**identification.sources, **checked.sources}
    if has_errors(checked.diagnostics):
        errors = tuple(d for d in checked.diagnostics if has_errors([d]))
        return identification._replace(diagnostics=errors, sources=sources)
    targets = tuple(
        Identified(name, target.cylinder, target.glances, tuple(_share(result, i) for i in target.glances))
        for name, target in zip(names, result.targets, strict=True)
    )
    return identification._replace(text=new_text, targets=targets, diagnostics=doubtful, sources=sources)


def _share(result: SearchResult, number: int) -> float:
    choice = result.choices[number]
    return 0.0 if choice is None else choice.share


def _names(mission: MissionIR, result: SearchResult) -> list[str]:
    """Return a unique name for each target: that in the file, adapted to the language, or a number."""
    taken = {target.name for target in (*mission.targets, *mission.groups)}
    names: list[str] = []
    for target in result.targets:
        own = NOT_IN_NAMES.sub("-", target.name or "").strip("-_")[:LONGEST_NAME_CHARACTERS].strip("-_")
        numbered = (f"{own or 'target'}-{n}" for n in range(2 if own else 1, 10_000))
        name = next(n for n in chain([own] if own else [], numbered) if n not in taken)
        taken.add(name)
        names.append(name)
    return names
