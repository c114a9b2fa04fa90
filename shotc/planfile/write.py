"""Write a verified plan as the bytes of plan.json, with all data to prove it again and to emit it again."""

from __future__ import annotations

import json
from collections.abc import Iterator
from hashlib import sha256
from typing import Any

from shotc import __version__
from shotc.ir.mission import ELSEWHERE_IN_PLANS, MissionIR
from shotc.ir.origin import KeyPath, OriginMap
from shotc.ir.trajectory import Claim, VerifiedIR
from shotc.planfile import layout
from shotc.planfile.codec import encode
from shotc.planfile.layout import as_lines

FORMAT = "shotc-plan"
VERSION = 1


def plan_bytes(plan: VerifiedIR) -> bytes:
    """Return the bytes of plan.json. The same plan gives the same bytes, and numbers read back exactly."""
    return layout.text(document(plan)).encode("ascii")


def document(plan: VerifiedIR) -> dict[str, Any]:
    """Return the JSON value of a plan."""
    ir = plan.trajectory
    mission = ir.keyframes.mission
    mission_fields = {k: v for k, v in encode_mission(mission).items() if k != "source_sha256"}
    return {
        "format": FORMAT,
        "version": VERSION,
        "tool": {"name": "shotc", "version": __version__},
        "source": _source(mission),
        "mission": mission_fields,
        "mission_sha256": seal(mission_fields),
        "keyframes": [
            {
                "shot": placed.shot.id,
                "keyframes": encode(placed.keyframes),
                "subjects": encode(placed.subjects),
            }
            for placed in ir.keyframes.shots
        ],
        "certificate": encode(plan.certificate),
        "deviations": encode(ir.deviations),
        "statistics": encode(ir.stats),
        "drones": encode(ir.drones),
        "fleets": encode(ir.fleets),
        "origins": _origins(mission, plan.certificate),
    }


def seal(mission: Any) -> str:
    """Return the SHA-256 of the mission's JSON value, hexadecimal. The layout of the file does not change it.

    The certificate covers most of a mission, but not the place on earth, a lens or a pad. The seal covers
    them, because the output files depend on them.
    """
    return sha256(json.dumps(mission, sort_keys=True, separators=(",", ":")).encode("ascii")).hexdigest()


def encode_mission(mission: MissionIR) -> dict[str, Any]:
    """Return the fields of a mission that a plan holds."""
    names = (name for name in MissionIR._fields if name not in ELSEWHERE_IN_PLANS)
    return {name: encode(getattr(mission, name)) for name in names}


def _source(mission: MissionIR) -> dict[str, Any]:
    """Return the text from which the mission was lowered, so that verification can lower it again."""
    source = mission.source
    linked = [{"name": name, "sha256": digest} for name, digest in source.linked]
    return {
        "file": mission.origins.file,
        "sha256": mission.source_sha256,
        "text": as_lines(source.text),
        "tables": [{"name": name, "text": as_lines(data)} for name, data in source.tables],
        "drawn": [{"name": name, "sha256": digest} for name, digest in source.drawn],
        "chosen": {
            "drones": [{"shot": shot, "drone": drone} for shot, drone in source.chosen.drones],
            "autopilot": source.chosen.autopilot,
        },
        **({"linked": linked} if linked else {}),
    }


def _origins(mission: MissionIR, certificate: tuple[Claim, ...]) -> dict[str, Any]:
    used = dict.fromkeys(_used(mission, certificate))
    origins: OriginMap = mission.origins
    return {
        kind: [[list(path), encode(table[path])] for path in used if path in table]
        for kind, table in (("keys", origins.keys), ("values", origins.values))
    }


def _used(mission: MissionIR, certificate: tuple[Claim, ...]) -> Iterator[KeyPath]:
    """Yield the key paths that a diagnostic of a plan can point to, each after its ancestors."""
    paths: list[KeyPath] = [claim.path for claim in certificate]
    for named in (mission.zones, mission.every_target, mission.drones, mission.shots):
        paths += [element.path for element in named]
    for elements in (mission.fleets, mission.displays):
        paths += [element.path for element in elements]
    paths += [fleet.key for fleet in mission.fleets]
    paths += [keyframe.path for shot in mission.shots for keyframe in shot.keyframes]
    for path in paths:
        for end in range(1, len(path) + 1):
            yield path[:end]
