"""Read plan.json. Any bytes give a plan or diagnostics, never an exception."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from typing import Any, NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.keyframes import KeyframeIR, PlacedKeyframe, PlacedShot, PlacedSubject
from shotc.ir.mission import ELSEWHERE_IN_PLANS, MissionIR
from shotc.ir.origin import KeyPath, OriginMap
from shotc.ir.path import Deviation
from shotc.ir.source import Autopilot, Chosen, MissionSource
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.planfile.codec import Decoder, FieldFault, hints, show
from shotc.planfile.layout import as_bytes
from shotc.planfile.sanity import inconsistencies
from shotc.planfile.write import FORMAT, VERSION, seal
from shotc.source.file import WHOLE_FILE, Span

LARGEST_BYTES = 256 * 2**20
LONGEST_VALUE_CHARACTERS = 1000  # digits of a number
"""Size of the largest plan that is read, bytes."""

MOST_REPORTED = 20
"""Most faults that are reported one by one. A file of another kind has thousands."""


_MISSION = re.compile(rb"^shotc[ \t]*:", re.MULTILINE)
"""The key that every mission has, in YAML's block style."""


@dataclass(frozen=True, slots=True)
class ReadPlan:
    """The content of a plan file: the trajectory, or None after a fault, and the certificate that it claims.

    tool   : the version of shotc that wrote it
    edited : whether its mission differs from the one that was planned
    """

    trajectory: TrajectoryIR | None
    certificate: tuple[Claim, ...]
    diagnostics: tuple[Diagnostic, ...]
    tool: str = ""
    edited: bool = False


class _NotJsonError(Exception):
    """A fault of the text itself, at ``span``."""

    def __init__(self, text: str, span: Span = WHOLE_FILE) -> None:
        super().__init__(text)
        self.span = span


def read_plan(data: bytes, name: str) -> ReadPlan:
    """Read the bytes of a plan.json. Diagnostics call it ``name``."""
    try:
        document = _parse(data)
    except _NotJsonError as fault:
        if _MISSION.search(data):
            return _refused(_mission_given("E001", name))
        label = Label(name, fault.span)
        return _refused(
            Diagnostic(
                "E001", f"this is no plan: {fault}", (label,), help="give the plan.json of `shotc plan`"
            )
        )
    foreign = _foreign(document, name)
    if foreign is not None:
        return _refused(foreign)
    decoder = Decoder([])
    trajectory, certificate = _decode(document, decoder)
    if not decoder.faults:
        decoder.faults += [FieldFault(*fault) for fault in inconsistencies(trajectory)]
    if decoder.faults:
        return _refused(*_report(decoder.faults, name))
    edited = seal(document["mission"]) != document["mission_sha256"]
    return ReadPlan(trajectory, certificate, (), document["tool"]["version"], edited)


def _refused(*diagnostics: Diagnostic) -> ReadPlan:
    return ReadPlan(None, (), diagnostics)


def _parse(data: bytes) -> Any:
    if len(data) > LARGEST_BYTES:
        raise _NotJsonError(f"it has {len(data)} bytes, more than {LARGEST_BYTES} are not read")
    try:
        text = data.decode("utf-8")
        return json.loads(text, parse_int=_integer, parse_constant=_constant, object_pairs_hook=_object)
    except UnicodeDecodeError as fault:
        raise _NotJsonError(f"byte {fault.start} is not UTF-8") from None
    except json.JSONDecodeError as fault:
        span = Span(fault.lineno, fault.colno, fault.lineno, fault.colno + 1)
        raise _NotJsonError(f"it is not JSON, {fault.msg[:1].lower()}{fault.msg[1:]}", span) from None
    except RecursionError:
        raise _NotJsonError("its values are nested too deeply") from None
    except ValueError as fault:
        raise _NotJsonError(str(fault)) from None


def _integer(text: str) -> int:
    if len(text) > LONGEST_VALUE_CHARACTERS:
        raise ValueError(f"a number has {len(text)} digits")
    return int(text)


def _constant(text: str) -> float:
    raise ValueError(f"{text} is not a number of JSON")


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    fields = dict(pairs)
    if len(fields) < len(pairs):
        names = [key for key, _ in pairs]
        twice = next(key for key in names if names.count(key) > 1)
        raise ValueError(f"the key {show(twice)} stands twice in one object")
    return fields


def _mission_given(code: str, name: str) -> Diagnostic:
    help_ = "run `shotc plan` on it first, then give the plan.json that it writes"
    return Diagnostic(code, "this is a mission, not a plan", (Label(name, WHOLE_FILE),), help=help_)


def _foreign(document: Any, name: str) -> Diagnostic | None:
    label = (Label(name, WHOLE_FILE),)
    if isinstance(document, dict) and "shotc" in document:
        return _mission_given("E002", name)
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        given = show(document.get("format")) if isinstance(document, dict) else show(document)
        return Diagnostic(
            "E002",
            "this JSON is not a shotc plan",
            label,
            notes=(f'its "format" is {given}, not `{FORMAT}`',),
            help="give the plan.json of `shotc plan`",
        )
    if document.get("version") is not VERSION:
        version = f"version {show(document['version'])}" if "version" in document else "no version"
        return Diagnostic(
            "E002",
            f"plans of {version} are not read by this shotc",
            label,
            notes=(f"this shotc reads version {VERSION}",),
            help="plan the mission again with this shotc, or install the one that wrote the plan",
        )
    return None


def _report(faults: list[FieldFault], name: str) -> list[Diagnostic]:
    label = (Label(name, WHOLE_FILE),)
    reported = [Diagnostic("E003", f"plan field `{f.path}`: {f.text}", label) for f in faults[:MOST_REPORTED]]
    if len(faults) > MOST_REPORTED:
        reported.append(
            Diagnostic("E003", f"and {len(faults) - MOST_REPORTED} more faults of this plan", label)
        )
    return reported


_Spans = tuple[tuple[KeyPath, Span], ...]

_DOCUMENT: dict[str, Any] = {
    "format": str,
    "version": int,
    "tool": object,
    "source": object,
    "mission": object,
    "mission_sha256": str,
    "keyframes": object,
    "certificate": tuple[Claim, ...],
    "deviations": tuple[Deviation, ...],
    "statistics": tuple[tuple[str, float | str], ...],
    "drones": tuple[DroneTrajectory, ...],
    "fleets": tuple[FleetTrajectory, ...],
    "origins": object,
}


def _decode(document: Any, decoder: Decoder) -> tuple[TrajectoryIR, tuple[Claim, ...]]:
    parts = decoder.fields(_DOCUMENT, document, "")
    decoder.fields({"name": str, "version": str}, parts.get("tool"), "tool")
    source = _source(parts.get("source"), decoder)
    spans = decoder.fields({"keys": _Spans, "values": _Spans}, parts.get("origins"), "origins")
    kinds = {k: v for k, v in hints(MissionIR).items() if k not in {*ELSEWHERE_IN_PLANS, "source_sha256"}}
    fields = decoder.fields(kinds, parts.get("mission"), "mission")
    if decoder.faults or source is None:
        return None, ()  # type: ignore[return-value]
    origins = OriginMap(source.file, dict(spans["keys"]), dict(spans["values"]))
    mission = MissionIR(**fields, source_sha256=source.sha256, origins=origins, source=source.source)
    keyframes = KeyframeIR(mission, _placed(parts["keyframes"], mission, decoder))
    known = (parts[name] for name in ("drones", "deviations", "statistics", "fleets"))
    trajectory = TrajectoryIR(keyframes, *known)
    return trajectory, parts["certificate"]


class _Source(NamedTuple):
    file: str
    sha256: str
    source: MissionSource


def _source(value: Any, decoder: Decoder) -> _Source | None:
    """Return the source of the mission, or None after a fault. Older plans do not hold its text."""
    kinds: dict[str, Any] = {"file": str, "sha256": str}
    if isinstance(value, dict) and not value.keys() <= kinds.keys():
        kinds |= {"text": tuple[str, ...], "tables": object, "drawn": object, "chosen": object}
        kinds |= {"linked": object} if "linked" in value else {}
    fields = decoder.fields(kinds, value, "source")
    if decoder.faults or "text" not in fields:
        return None if decoder.faults else _Source(fields["file"], fields["sha256"], MissionSource())
    tables = _pairs(fields["tables"], {"name": str, "text": tuple[str, ...]}, "source.tables", decoder)
    drawn = _pairs(fields["drawn"], {"name": str, "sha256": str}, "source.drawn", decoder)
    linked = _pairs(fields.get("linked", []), {"name": str, "sha256": str}, "source.linked", decoder)
    choices = {"drones": object, "autopilot": Autopilot | None}
    chosen = decoder.fields(choices, fields["chosen"], "source.chosen")
    drones = _pairs(chosen.get("drones"), {"shot": str, "drone": str}, "source.chosen.drones", decoder)
    if decoder.faults:
        return None
    try:
        text = as_bytes(fields["text"])
        read = tuple((name, as_bytes(table)) for name, table in tables)
    except ValueError:
        decoder.fault("source", "a text in it is that of no file")
        return None
    return _Source(
        fields["file"],
        fields["sha256"],
        MissionSource(text, read, drawn, Chosen(drones, chosen["autopilot"]), linked),
    )


def _pairs(value: Any, kinds: dict[str, Any], path: str, decoder: Decoder) -> tuple[tuple[Any, Any], ...]:
    """Return pairs from a list of objects with two fields."""
    if not isinstance(value, list):
        decoder.fault(path, f"{show(value)} is not a list")
        return ()
    items = [decoder.fields(kinds, item, f"{path}[{i}]") for i, item in enumerate(value)]
    first, second = kinds
    return tuple((item[first], item[second]) for item in items if len(item) == len(kinds))


def _placed(value: Any, mission: MissionIR, decoder: Decoder) -> tuple[PlacedShot, ...]:
    shots = {shot.id: shot for shot in mission.shots}
    kinds = {"shot": str, "keyframes": tuple[PlacedKeyframe, ...], "subjects": tuple[PlacedSubject, ...]}
    if not isinstance(value, list):
        decoder.fault("keyframes", f"{show(value)} is not a list")
        return ()
    placed_shots: list[PlacedShot] = []
    for i, item in enumerate(value):
        fields = decoder.fields(kinds, item, f"keyframes[{i}]")
        shot = shots.get(fields.get("shot", ""))
        if shot is not None and len(fields.get("keyframes", ())) == len(shot.keyframes):
            placed_shots.append(PlacedShot(shot, fields["keyframes"], fields.get("subjects", ())))
        elif len(fields) == len(kinds):
            decoder.fault(
                f"keyframes[{i}]",
                "names no shot of the mission, or does not have as many keyframes as that",
            )
    return tuple(placed_shots)
