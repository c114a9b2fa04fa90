"""The faults in the shape of a mission, with their place in the text."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from pydantic import ValidationError

from shotc.diag.model import Diagnostic, Label
from shotc.diag.registry import code_of
from shotc.ir.origin import KeyPath, OriginMap
from shotc.source.fault import capped
from shotc.source.file import WHOLE_FILE, SourceFile
from shotc.source.syntax import value_in_comment
from shotc.spec.mission import VERSION, is_version
from shotc.spec.shot import ShotBase
from shotc.spec.translate import UnplacedFault, findings
from shotc.spec.words import nearest
from shotc.units import clip


def shape_faults(
    root: Mapping[str, Any],
    error: ValidationError | None,
    kinds: tuple[Mapping[str, type[ShotBase]], Mapping[str, Diagnostic]],
    origins: OriginMap,
    file: SourceFile,
) -> tuple[Diagnostic, ...]:
    """Return the faults of keys and values below ``root``; for an unknown language version only that fault.

    error : the models' faults, without that of the version; file : the text
    kinds : the usable kinds, and the diagnostics of unusable registered ones
    """
    usable, unusable = kinds
    broken_rules = _version_findings(root)
    if not any(f.slug == "unknown-version" for f in broken_rules):
        faults = findings(error) if error is not None else []
        broken_rules += [f for f in faults if f.path != ("shotc",)] + _shot_findings(
            root, [*usable, *unusable]
        )
    broken = tuple(_broken_kinds(root, unusable, origins))
    return _diagnostics([_uncovered(f, origins, file) for f in broken_rules], origins, broken)


def _broken_kinds(
    root: Mapping[str, Any], unusable: Mapping[str, Diagnostic], origins: OriginMap
) -> Iterator[Diagnostic]:
    """Yield the diagnostics of unusable kinds that shots name, at the line of the first such shot."""
    shots = root.get("shots", [])
    named = [shot.get("kind") for shot in shots if isinstance(shot, dict)] if isinstance(shots, list) else []
    for kind in dict.fromkeys(kind for kind in named if isinstance(kind, str) and kind in unusable):
        first = next(i for i, shot in enumerate(shots) if isinstance(shot, dict) and shot.get("kind") == kind)
        yield unusable[kind]._replace(labels=(origins.value(("shots", first, "kind")),))


def _uncovered(finding: UnplacedFault, origins: OriginMap, file: SourceFile) -> UnplacedFault:
    """Return the fault of a key without a value with a note if its value is in a comment behind a `#`."""
    if finding.slug != "empty-value":
        return finding
    line = file.line(origins.key(finding.path).span.line)
    hidden = value_in_comment(line, origins.key(finding.path).span.end_column - 1, len(line))
    if hidden is None:
        return finding
    value = clip(line[slice(*hidden)])
    return finding._replace(help=f'`#` begins a comment; put the value in quotes: "{value}"')


def plan_given(name: str) -> Diagnostic:
    """Return the single fault of a plan that is given instead of a mission."""
    label = (Label(name, WHOLE_FILE),)
    help_ = "give the mission's YAML file; `shotc verify`, `emit`, `view` and `diff` take plans"
    return Diagnostic(code_of("not-a-mission"), "this is a plan, not a mission", label, help=help_)


def _version_findings(root: Mapping[str, Any]) -> list[UnplacedFault]:
    help_ = f"write `shotc: {VERSION}` as the first line"
    if "shotc" not in root:
        message = "the mission does not say its language version"
        return [UnplacedFault((), "missing-version", message, help_, blame="key")]
    value = root["shotc"]
    if is_version(value):
        return []
    message = "`shotc` is the version of the language, a number"
    if isinstance(value, int | float) and not isinstance(value, bool):
        message = f"language version {clip(format(value, '.6g'))} is not known"
    note = f"this version of shotc reads language version {VERSION}"
    return [UnplacedFault(("shotc",), "unknown-version", message, help_, (note,))]


def _shot_findings(root: Mapping[str, Any], kinds: list[str]) -> list[UnplacedFault]:
    """Return the faults of unknown kinds, and of a mission without shots."""
    shots = root.get("shots", [])
    if shots == []:
        path: KeyPath = ("shots",) if "shots" in root else ()
        help_ = "add a shot, or start from a template: shotc new"
        return [UnplacedFault(path, "no-shots", "the mission has no shots", help_, blame="key")]
    if not isinstance(shots, list):
        return []
    named = [(i, shot["kind"]) for i, shot in enumerate(shots) if isinstance(shot, dict) and "kind" in shot]
    return [
        _unknown_kind(("shots", i, "kind"), kind, kinds)
        for i, kind in named
        if isinstance(kind, str) and kind not in kinds
    ]


def _unknown_kind(path: KeyPath, kind: str, kinds: Iterable[str]) -> UnplacedFault:
    help_ = nearest(kind, kinds)
    if "did you mean" not in help_:
        help_ += "; `shotc list kinds` says what each does"
    return UnplacedFault(path, "unknown-kind", f"unknown kind of shot `{clip(kind)}`", help_)


def _diagnostics(
    faults: list[UnplacedFault], origins: OriginMap, others: tuple[Diagnostic, ...]
) -> tuple[Diagnostic, ...]:
    """Return one diagnostic for each faulty place, and the others, in the order of the file."""
    first: dict[tuple[KeyPath, str], UnplacedFault] = {}
    for finding in faults:
        first.setdefault((finding.path, finding.message if finding.blame == "key" else ""), finding)
    every = [_diagnostic(f, origins) for f in first.values()]
    return capped(sorted([*every, *others], key=lambda d: d.sort_key), "this file")


def _diagnostic(finding: UnplacedFault, origins: OriginMap) -> Diagnostic:
    label = origins.value(finding.path) if finding.blame == "value" else origins.key(finding.path)
    if finding.path == ():
        label = Label(origins.file, WHOLE_FILE)
    related = (origins.key(finding.beside, "given here"),) if finding.beside else ()
    return Diagnostic(code_of(finding.slug), finding.message, (label, *related), finding.notes, finding.help)
