"""A plan held to its file: its certificate, the mission in it, and the world that it was made with."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from shotc import __version__
from shotc.diag.model import Diagnostic
from shotc.geom.surface.ground import ground_of
from shotc.geom.surface.tree import surface_of
from shotc.ir.keyframes import KeyframeIR, Lowered
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.origin import OriginMap
from shotc.ir.passes import PassContext
from shotc.ir.source import MissionSource
from shotc.ir.terrain import Terrain
from shotc.ir.trajectory import Claim
from shotc.passes.verify.file import _against_the_file, against, verify_file
from shotc.planfile.read import ReadPlan
from shotc.source.file import SourceFile, Span
from tests.support.film_plans import SPEED, orbit_mission
from tests.support.records import replace

FILE = SourceFile("mission.yaml", "shotc: 1\n")
FAULT = Diagnostic("E001", "a fault of the mission", ())


def held(written: MissionIR, lowered: MissionIR | None, reviewed: MissionIR) -> list[str]:
    """What is told of a plan of a mission against a file: paths and texts are one."""
    now = Lowered(KeyframeIR(reviewed, ()), (), FILE)
    mine = None if lowered is None else KeyframeIR(lowered, ())
    found = against(KeyframeIR(written, ()), mine, now)
    assert {d.code for d in found} <= {"V043"}
    return [d.message for d in found]


def drawn_by(*drawn: tuple[str, str], linked: Sequence[tuple[str, str]] = ()) -> MissionIR:
    mission = orbit_mission()
    return mission._replace(source=MissionSource(mission.source.text, drawn=drawn, linked=tuple(linked)))


def test_the_mission_of_the_file_is_no_other() -> None:
    mission = drawn_by(("star.svg", "1" * 64), linked=[("house.glb", "2" * 64)])
    assert held(mission, mission, mission) == []
    assert held(mission, None, mission) == []


def test_a_file_that_is_drawn_or_linked_is_the_same() -> None:
    mine = drawn_by(("star.svg", "1" * 64), ("sun.svg", "3" * 64), linked=[("house.glb", "2" * 64)])
    other = drawn_by(("star.svg", "4" * 64), ("sun.svg", "3" * 64), linked=[("house.glb", "5" * 64)])
    assert held(mine, None, other) == [
        "`star.svg` is another file than the plan draws",
        "`house.glb` is another file than the plan was made with",
    ]
    assert held(drawn_by(), None, other) == []  # a name that only the file has is a difference of the mission


def test_a_comment_that_moves_all_lines_is_no_difference() -> None:
    mission = orbit_mission()
    places = {("drones", "cam1"): Span(1, 1, 1, 9)}
    moved = mission._replace(origins=OriginMap("mission.yaml", places, places))
    assert held(mission, None, moved) == held(moved, moved, mission) == []


def triangles(height: float) -> np.ndarray:
    return np.array([[[0.0, 0.0, height], [9.0, 0.0, height], [0.0, 9.0, height]]])


def world(kind: str, height: float | None, mission: MissionIR | None = None) -> MissionIR:
    """The mission with a triangle of the kind at a height, or without one."""
    of = orbit_mission() if mission is None else mission
    if height is None:
        return of
    if kind == "terrain":
        return of._replace(terrain=Terrain(ground_of(triangles(height)[0], np.arange(3)[None]), "hill.tif"))
    none = np.zeros(1, dtype=np.intp)
    mesh = ObstacleMesh(
        kind,  # type: ignore[arg-type]
        "it.glb", surface_of(triangles(height)), none, ("it",), none, np.zeros(1, dtype=bool),
    )  # fmt: skip
    return of._replace(meshes=(*of.meshes, mesh))


WORDS = {
    "terrain": "the terrain is another than the plan was made with",
    "scene": "the scene is another than the plan was made with",
    "buildings": "the buildings are another than the plan was made with",
}


@pytest.mark.parametrize("kind", WORDS)
@pytest.mark.parametrize(
    ("mine", "true", "same"),
    [(None, None, True), (1.0, 1.0, True), (1.0, 2.0, False), (None, 1.0, False), (1.0, None, False)],
)
def test_the_world_is_the_one_that_the_plan_was_made_with(
    kind: str, mine: float | None, true: float | None, same: bool
) -> None:
    found = held(orbit_mission(), world(kind, mine), world(kind, true))
    assert [text for text in found if "was made with" in text] == ([] if same else [WORDS[kind]])


def test_each_part_of_the_world_is_compared_with_its_own_kind() -> None:
    mine = world("buildings", 2.0, world("scene", 1.0))
    swapped = world("buildings", 1.0, world("scene", 2.0))
    assert held(orbit_mission(), mine, world("scene", 1.0, world("buildings", 2.0))) == []
    assert held(orbit_mission(), mine, swapped) == [WORDS["scene"], WORDS["buildings"]]


def test_a_mission_that_cannot_be_lowered_holds_no_plan() -> None:
    found = against(KeyframeIR(orbit_mission(), ()), None, Lowered(None, (FAULT,), FILE))
    assert [d.code for d in found] == ["V043", "E001"]
    assert found[0].labels[0].file == "mission.yaml"


def certified(claims: Sequence[Claim], *, tool: str = __version__, edited: bool = False) -> list[Diagnostic]:
    """What is told of a certificate where two dozen claims are proved."""
    read = ReadPlan(None, tuple(claims), (), tool, edited)
    found = _against_the_file(read, PROVED, "plan.json")
    assert {d.code for d in found} <= {"V040"}
    return found


PROVED: tuple[Claim, ...] = tuple(replace(SPEED, shot=f"s{i}") for i in range(24))


def broken(count: int) -> list[Claim]:
    """The certificate with other limits in its first claims."""
    return [replace(c, limit=9.0) if i < count else c for i, c in enumerate(PROVED)]


@pytest.mark.parametrize("tool", [__version__, "0.0.1"])
def test_a_certificate_that_is_proved_is_told_of_in_an_edited_plan_alone(tool: str) -> None:
    assert certified(PROVED, tool=tool) == []
    (found,) = certified(PROVED, tool=tool, edited=True)
    assert found.message == "the mission in this plan is not the one it was planned for"


@pytest.mark.parametrize("edited", [True, False])
@pytest.mark.parametrize("count", [1, 10, 11, 15])
def test_the_first_differing_claims_are_told_each(count: int, edited: bool) -> None:
    texts = [d.message for d in certified(broken(count), edited=edited)]
    assert texts[:10] == [
        f"cam1: speed of shot `s{i}`: the limit is 9 m/s in the certificate, 8 m/s in the plan"
        for i in range(min(count, 10))
    ]
    more = [f"{count - 10} more claims of the certificate differ"] * (count > 10)
    assert texts[10:] == more


@pytest.mark.parametrize("edited", [True, False])
@pytest.mark.parametrize("count", [1, 3, 5])
def test_differing_claims_of_another_shotc_are_told_together(count: int, edited: bool) -> None:
    (found,) = certified(broken(count), tool="0.0.1", edited=edited)
    assert found.message == f"{count} claims of the certificate differ"
    assert found.notes[0] == f"the file was written by shotc 0.0.1, this is {__version__}"
    assert len(found.notes) == 1 + min(count, 3)


def test_what_is_no_plan_is_not_lowered() -> None:
    def lower(source: MissionSource, file: str) -> Lowered:
        raise AssertionError

    found = verify_file(b"{}", "plan.json", PassContext(), lower)
    assert (found.plan, found.certificate, found.mission) == (None, (), None)
    assert [d.code for d in found.diagnostics] == ["E002"]
