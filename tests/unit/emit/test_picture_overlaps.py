"""No label of a picture or map lies over a target, a mark or another label."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
import pytest

from shotc.emit.storyboard import EMITTER, frame, map, page
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, house_style
from shotc.emit.storyboard.labels import MAP_SIDES, MapLabel, nearest_room, write_labels
from shotc.emit.storyboard.map import NUMBER_RADIUS_IN
from shotc.geom.bernstein import Piecewise
from shotc.geom.shapes import CylinderShape
from shotc.ir.path import CAM_PITCH, CAM_YAW
from shotc.ir.target import Target
from shotc.ir.trajectory import VerifiedIR
from tests.support.film_plans import TOWER, orbit_plan
from tests.support.page_texts import Written, texts
from tests.support.records import replace
from tests.support.two_target_plans import pair_plan


@contextmanager
def bodies() -> Iterator[list[tuple[str, PageRectangle]]]:
    """Collect the targets and pads that pictures and maps show, by name, with the rectangle each takes."""
    found: list[tuple[str, PageRectangle]] = []
    places, shape, pad = frame.name_places, map._body, map._pad

    def seen(shown, mission):
        things = places(shown, mission)
        names = {target.name for target in mission.targets}
        found.extend((thing.name, thing.place) for thing in things if thing.name in names)
        return things

    def drawn(sheet, target):
        outline = shape(sheet, target)
        if (place := sheet.visible(outline)) is not None:
            found.append((target.name, place))
        return outline

    def padded(sheet, board):
        found.extend(("pad", place) for place in pad(sheet, board))
        return pad(sheet, board)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(map, "_pad", padded)
        patch.setattr(frame, "name_places", seen)
        patch.setattr(map, "_body", drawn)
        yield found


def overlaps(plan: VerifiedIR) -> list[str]:
    """Return which texts of a plan's storyboard lie over a target or another text."""
    with texts() as written, bodies() as seen:
        EMITTER.emit(plan)
    labels = [t for t in written if t.text.strip()]
    found = [
        f"{t.text} over target {name}"
        for t in labels
        for name, body in {(n, (b.x, b.y, b.width, b.height)): (n, b) for n, b in seen}.values()
        if inner(t).meets(body)
    ]
    pairs = ((a, b) for i, a in enumerate(labels) for b in labels[i + 1 :])
    return found + [f"{a.text} over {b.text}" for a, b in pairs if inner(a).meets(inner(b))]


def inner(text: Written) -> PageRectangle:
    """Return the rectangle of a text; that of a number is its disc's."""
    if text.text.isdigit() or text.text == "W":
        x, y = text.box.x + text.box.width / 2, text.box.y + text.box.height / 2
        return PageRectangle(
            x - NUMBER_RADIUS_IN + 0.001,
            y - NUMBER_RADIUS_IN + 0.001,
            2 * NUMBER_RADIUS_IN - 0.002,
            2 * NUMBER_RADIUS_IN - 0.002,
        )
    return text.box


def crowded() -> VerifiedIR:
    """The half orbit among six targets that stand close together, with long names."""
    plan = orbit_plan()
    near = tuple(
        Target(
            f"neighbour-{i}-of-the-tower",
            (6.0 * np.cos(a), 6.0 * np.sin(a), 4.0),
            CylinderShape(2.0, 8.0),
            ("targets",),
        )
        for i, a in enumerate(np.linspace(0.0, 5.2, 6))
    )
    return among(plan, (TOWER, *near))


def straight_down() -> VerifiedIR:
    """The half orbit's flight with its camera above the tower, looking straight down."""
    plan = orbit_plan()
    (flight,) = plan.trajectory.drones
    ctrl = flight.curve.ctrl.copy()
    ctrl[..., :2] *= 0.02
    ctrl[..., 2] = 60.0
    ctrl[..., CAM_YAW], ctrl[..., CAM_PITCH] = np.pi / 2, -np.pi / 2
    above = replace(flight, curve=Piecewise(flight.curve.breaks, ctrl))
    return VerifiedIR(replace(plan.trajectory, drones=(above,)), plan.certificate)


def over_its_pad() -> VerifiedIR:
    """The half orbit of a drone whose pad is below the first keyframe."""
    plan = orbit_plan()
    keyframes = plan.trajectory.keyframes
    x, y, _ = keyframes.mission.shots[0].keyframes[0].at
    drone = replace(keyframes.mission.drones[0], home=(x, y, 0.0))
    mission = replace(keyframes.mission, drones=(drone,))
    return VerifiedIR(
        replace(plan.trajectory, keyframes=replace(keyframes, mission=mission)), plan.certificate
    )


def among(plan: VerifiedIR, targets: tuple[Target, ...]) -> VerifiedIR:
    keyframes = plan.trajectory.keyframes
    mission = replace(keyframes.mission, targets=targets)
    return VerifiedIR(
        replace(plan.trajectory, keyframes=replace(keyframes, mission=mission)), plan.certificate
    )


@pytest.mark.long
@pytest.mark.parametrize("make", [orbit_plan, pair_plan, crowded, straight_down, over_its_pad])
def test_no_label_lies_over_a_target_or_another_label(make: Callable[[], VerifiedIR]) -> None:
    assert overlaps(make()) == []


def test_a_label_without_room_beside_its_thing_stands_in_the_nearest_free_place() -> None:
    page_box = PageRectangle(0.0, 0.0, 4.0, 3.0)
    thing = PageRectangle(1.9, 1.4, 0.2, 0.2)
    around = PageRectangle(1.0, 1.0, 2.0, 1.0)
    room = nearest_room((0.5, 0.1), page_box, thing, [around])
    assert room is not None
    assert not room.meets(around)
    assert page_box.holds(room)
    assert min(abs(room.top - around.y), abs(room.y - around.top)) < 0.11
    assert nearest_room((0.5, 0.1), page_box, thing, [page_box]) is None


def test_a_label_without_any_room_is_handed_back() -> None:
    label = MapLabel("lost", (0.0, 0.0, 0.0), PageRectangle(1.0, 1.0, 0.2, 0.2), MAP_SIDES)
    with house_style():
        canvas, whole = Canvas(4.0, 3.0, 50.0), PageRectangle(0.0, 0.0, 4.0, 3.0)
        assert write_labels(canvas, whole, [label], [whole]) == ["lost"]
        assert write_labels(canvas, whole, [label], []) == []


@pytest.mark.slow
def test_a_small_target_is_seen_inside_of_its_mark(monkeypatch: pytest.MonkeyPatch) -> None:
    discs: list[float] = []
    disc = Canvas.disc

    def drawn(self, at, radius, *rest):
        discs.append(radius)
        disc(self, at, radius, *rest)

    monkeypatch.setattr(Canvas, "disc", drawn)
    small = among(straight_down(), (replace(TOWER, shape=CylinderShape(0.4, 1.8), centre=(0.0, 0.0, 0.9)),))
    for plan, dots in ((straight_down(), 5), (small, 0)):
        discs.clear()
        page.draw_page(plan, 40.0)
        assert discs.count(frame.DOT_IN) == dots
