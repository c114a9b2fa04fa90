"""The contact sheet: what is on it, where lights are in a frame, and that it is the same every time."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from shotc.emit.audience import ASPECT, audience
from shotc.emit.palette import CAMERA, QUIET, STONE
from shotc.emit.storyboard.canvas import PageRectangle
from shotc.emit.storyboard.sheet import Sheet
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FrameTimes
from shotc.ir.trajectory import VerifiedIR
from shotc.rounding import as_minutes
from shotc.show.emit.contact_sheet import EMITTER
from shotc.show.emit.contact_sheet.moments import MOST_MOMENTS, boards, lights
from shotc.show.emit.contact_sheet.night import UNLIT_GREY_LEVEL, hidden_lights, night
from shotc.show.emit.contact_sheet.page import MAP_IN, MARGIN_IN, WIDTH_IN
from shotc.show.emit.contact_sheet.scenery import Scenery, backdrop, scenery
from shotc.show.emit.contact_sheet.stands import anchors, outlines
from tests.support import show_flights
from tests.support.film_plans import orbit_plan
from tests.support.page_texts import texts
from tests.support.records import replace
from tests.support.standing_worlds import STEP, height_over, house, ridge, terrain
from tests.support.surfaces import grid

SIZE = (480, 270)


@pytest.mark.slow
def test_a_page_with_both_pictures() -> None:
    (artifact,) = EMITTER.emit(show_flights.plan()).artifacts
    assert artifact.name == "contact-sheet.png"
    page = np.asarray(Image.open(BytesIO(artifact.data)).convert("RGB")).astype(int)
    red, _, blue = np.moveaxis(page, -1, 0)
    assert (red > blue + 100).sum() > 500  # the orange sphere
    assert (blue > red + 100).sum() > 500  # the blue cube
    assert EMITTER.emit(show_flights.plan()).artifacts[0].data == artifact.data


def crowded(count: int, apart: float) -> VerifiedIR:
    """A show of so many pictures, one after another, each so many metres beside the one before."""
    display = show_flights.display()
    displays = (display._replace(pictures=(display.pictures * count)[:count]),)
    plan = show_flights.plan(show_flights.mission(displays=displays))
    flight = plan.trajectory.fleets[0]
    shown = tuple(FrameTimes("shapes", i, 0, 26.0 + i, 26.2 + i) for i in range(count))
    coef = flight.coef + apart * np.linspace(0.0, 1.0, flight.coef.shape[1])[:, None] * [1.0, 0.3, 0.0]
    flight = replace(flight, shown=shown, coef=coef)
    return replace(plan, trajectory=replace(plan.trajectory, fleets=(flight,)))


@pytest.mark.long
@pytest.mark.parametrize("apart", [0.0, 60.0])
@pytest.mark.parametrize("count", [2, 5, 10])
def test_the_map_has_a_number_for_each_picture_and_none_is_over_another(count: int, apart: float) -> None:
    with texts() as found:
        EMITTER.emit(crowded(count, apart))
    here = [t for t in found if t.box.x < MARGIN_IN + MAP_IN and t.style.color != QUIET and t.style.size < 12]
    numbers = [t.text for t in here if t.text.isdigit()]
    assert sorted(numbers, key=int) == [str(k + 1) for k in range(count)]
    captions = [t.text for t in found if t.text.isdigit() and t not in here]
    assert captions == [str(k + 1) for k in range(count)]
    assert min(t.capital for t in found) >= 9.0 - 1e-9
    for k, one in enumerate(here):
        assert not [other.text for other in here[k + 1 :] if one.box.meets(other.box)]


def test_a_number_leads_to_its_own_outline() -> None:
    (board,) = boards(crowded(5, 40.0))
    sheet = Sheet(PageRectangle(0.0, 0.0, 4.0, 6.0), np.eye(3)[:2], np.zeros(2), 0.02)
    shapes = outlines(board, sheet)
    for shape, anchor in zip(shapes, anchors(shapes), strict=True):
        ends = np.roll(shape, -1, axis=0)
        along = np.clip(((anchor - shape) * (ends - shape)).sum(-1) / ((ends - shape) ** 2).sum(-1), 0.0, 1.0)
        assert np.linalg.norm(shape + along[:, None] * (ends - shape) - anchor, axis=1).min() < 1e-9


def test_moments_are_pictures_at_their_holds() -> None:
    (board,) = boards(show_flights.plan())
    assert [(m.name, m.time) for m in board.moments] == [("sphere", 27.5), ("cube", 40.5)]
    assert board.moments[1].way == (31.5, 34.0, 36.5)
    assert board.span == (26.0, 42.0)


def test_an_animation_is_shown_by_a_few_of_its_frames() -> None:
    plan = show_flights.plan()
    shown = tuple(FrameTimes("shapes", 0, i, 26.0 + i * 0.5, 26.0 + i * 0.5) for i in range(30))
    (board,) = boards(with_shown(plan, shown))
    assert [m.part for m in board.moments] == [(1, 30), (11, 30), (20, 30), (30, 30)]
    assert board.total == 30


def test_many_pictures_are_thinned() -> None:
    plan = show_flights.plan()
    display = show_flights.display()
    many = display._replace(pictures=display.pictures * 20)
    plan = show_flights.plan(show_flights.mission(displays=(many,)))
    shown = tuple(FrameTimes("shapes", i, 0, 26.0 + 0.4 * i, 26.2 + 0.4 * i) for i in range(40))
    (board,) = boards(with_shown(plan, shown))
    assert len(board.moments) == MOST_MOMENTS
    assert (board.moments[0].start, board.moments[-1].start) == (shown[0].start, shown[-1].start)


def with_shown(plan: VerifiedIR, shown: tuple[FrameTimes, ...]) -> VerifiedIR:
    flight = replace(plan.trajectory.fleets[0], shown=shown)
    return replace(plan, trajectory=replace(plan.trajectory, fleets=(flight,)))


def test_lights_are_where_the_camera_has_them() -> None:
    plan = show_flights.plan(show_flights.mission(1))
    flight = plan.trajectory.fleets[0]
    seen = audience(plan, plan.trajectory.keyframes.mission.displays[0], ASPECT)
    behind = scenery(plan.trajectory.keyframes.mission, seen, SIZE)
    picture = night((flight,), 27.5, behind).astype(int).sum(axis=-1)
    row, column = np.unravel_index(int(np.argmax(picture)), picture.shape)
    away = places(flight.breaks, flight.coef, np.array([27.5]))[0, 0] - np.array(seen.eye)
    u, v, _ = seen.view(ASPECT).project((away[0], away[1], away[2]))
    assert abs(column + 0.5 - (u + 1) / 2 * SIZE[0]) <= 1.0
    assert abs(row + 0.5 - (1 - v) / 2 * SIZE[1]) <= 1.0


def test_the_pictures_are_in_the_middle_of_the_frame() -> None:
    plan = show_flights.plan()
    flight = plan.trajectory.fleets[0]
    seen = audience(plan, plan.trajectory.keyframes.mission.displays[0], ASPECT)
    away = places(flight.breaks, flight.coef, np.linspace(26.0, 42.0, 40)).reshape(-1, 3) - np.array(seen.eye)
    u, v, _ = seen.view(ASPECT).project((away[:, 0], away[:, 1], away[:, 2]))
    for along in (u, v):
        assert abs(along.max() + along.min()) < 0.02
    # The longer way fills the frame but for an even border.
    assert 0.8 < max(u.max(), v.max()) < 0.9


def test_a_frame_of_the_way_there_holds_the_fleet_then() -> None:
    plan = show_flights.plan()
    flight, (board,) = plan.trajectory.fleets[0], boards(plan)
    way = board.moments[0].way
    seen = audience(plan, board.display, ASPECT, way)
    away = places(flight.breaks, flight.coef, np.array(way)).reshape(-1, 3) - np.array(seen.eye)
    u, v, _ = seen.view(ASPECT).project((away[:, 0], away[:, 1], away[:, 2]))
    assert max(np.abs(u).max(), np.abs(v).max()) < 1.0


@pytest.mark.slow
def test_without_a_viewpoint_the_audience_stands_in_the_south() -> None:
    plan = show_flights.plan(show_flights.mission(displays=(show_flights.display(viewpoint=None),)))
    seen = audience(plan, plan.trajectory.keyframes.mission.displays[0], ASPECT)
    assert not seen.placed
    assert seen.eye[1] < show_flights.CENTRE[1] - 20.0
    assert seen.eye[2] == 1.7
    assert EMITTER.emit(plan).artifacts


def test_without_a_viewpoint_the_audience_stands_on_the_ground_and_on_roofs() -> None:
    shows = (show_flights.display(viewpoint=None),)
    level = show_flights.plan(show_flights.mission(displays=shows))
    x, y, _ = audience(level, shows[0], ASPECT).eye
    shape = ridge(40.0, at=x)
    hill = show_flights.plan(show_flights.mission(displays=shows, terrain=terrain(shape)))
    eye = np.array(audience(hill, shows[0], ASPECT).eye)
    assert eye[:2].tolist() == [x, y]
    assert height_over(shape, eye) == pytest.approx(1.7)
    built = show_flights.mission(displays=shows, meshes=(house((x, y, 6.0), (20.0, 20.0, 12.0)),))
    assert audience(show_flights.plan(built), shows[0], ASPECT).eye == (x, y, 13.7)


def behind_a_ridge(height: float) -> tuple[VerifiedIR, Scenery, np.ndarray]:
    """A show behind a ridge that runs along x, its picture without lights, and which drones the ridge hides.

    The audience stands at y = -50 and z = 2, the crest is at y = 0.
    """
    shape = grid(ridge(height, at=0.0, half=30.0).heights.T, STEP)
    plan = show_flights.plan(show_flights.mission(terrain=terrain(shape)))
    seen = audience(plan, plan.trajectory.keyframes.mission.displays[0], ASPECT)
    flight = plan.trajectory.fleets[0]
    at = places(flight.breaks, flight.coef, np.array([27.5]))[:, 0]
    share = np.linspace(0.0, 1.0, 4001)[:, None, None]
    ways = np.array(seen.eye) + share * (at - np.array(seen.eye))
    return (
        plan,
        scenery(plan.trajectory.keyframes.mission, seen, SIZE),
        (height_over(shape, ways) < 0).any(axis=0),
    )


@pytest.mark.slow
def test_a_hill_hides_the_lights_behind_it() -> None:
    plan, behind, hidden = behind_a_ridge(22.0)
    flight = plan.trajectory.fleets[0]
    at = places(flight.breaks, flight.coef, np.array([27.5]))[:, 0]
    assert 10 < hidden.sum() < len(hidden) - 10
    told = behind.hides(at)
    assert not (told & ~hidden).any()
    assert (told != hidden).sum() <= 2  # those a pixel below the crest
    assert hidden_lights(flight, 27.5, behind) == told.sum()
    shining = replace(flight.lights, colors=flight.lights.colors[~told])
    without = replace(flight, coef=flight.coef[~told], lights=shining)
    assert (night((flight,), 27.5, behind) == night((without,), 27.5, behind)).all()


@pytest.mark.slow
def test_hills_and_houses_stand_in_the_pictures_at_night() -> None:
    _, behind, _ = behind_a_ridge(22.0)
    rows, columns = SIZE[1], SIZE[0]
    flat = backdrop(behind.seen, SIZE)
    hill = (behind.colors != flat).any(axis=-1)
    # The crest, 22 m high and 50 m away, is level in the picture.
    _, v, _ = behind.seen.view(ASPECT).project((0.0, 50.0, 20.0))
    crest = (1.0 - v) / 2.0 * rows
    assert abs(hill[:, columns // 2].argmax() - crest) <= 1.5
    assert hill[int(crest) + 2 :].all()
    mission = show_flights.mission(meshes=(house((0.0, 20.0, 10.0), (10.0, 10.0, 20.0)),))
    front = scenery(mission, behind.seen, SIZE)
    wall = (front.colors != flat).any(axis=-1)
    view = behind.seen.view(ASPECT)
    u, v, _ = view.project((np.array([-5.0, 5.0]), np.array([65.0, 65.0]), np.array([18.0, 18.0])))
    across, top = (u + 1.0) / 2.0 * columns, (1.0 - v[0]) / 2.0 * rows
    shown = np.flatnonzero(wall[int(top) + 2])
    assert abs(shown[0] - across[0]) <= 1.5
    assert abs(shown[-1] + 1 - across[1]) <= 1.5
    assert abs(wall.any(axis=1).argmax() - top) <= 1.5
    assert front.colors[wall].mean() > behind.colors[hill].mean()


def test_no_fleet_no_sheet() -> None:
    emission = EMITTER.emit(orbit_plan())
    assert emission.artifacts == ()
    assert len(emission.notes) == 1


@pytest.mark.slow
def test_a_picture_counts_the_lights_that_shine() -> None:
    plan = show_flights.plan()
    flight = plan.trajectory.fleets[0]
    colors = flight.lights.colors.copy()
    colors[:17] = 0
    dark = replace(flight, lights=replace(flight.lights, colors=colors))
    assert lights(flight, 27.5) == len(flight.coef)
    assert lights(dark, 27.5) == len(flight.coef) - 17
    with texts() as found:
        EMITTER.emit(replace(plan, trajectory=replace(plan.trajectory, fleets=(dark,))))
    assert sum(t.text.endswith(f"{len(flight.coef) - 17} of {len(flight.coef)} lights") for t in found) == 2


@pytest.mark.slow
def test_many_drones_whose_lights_are_off_are_no_brighter_than_one() -> None:
    plan = show_flights.plan()
    flight = plan.trajectory.fleets[0]
    seen = audience(plan, show_flights.display(), ASPECT)
    behind = Scenery(seen, np.zeros((SIZE[1], SIZE[0], 3)), np.full((SIZE[1], SIZE[0]), np.inf))
    one = flight.coef[:1].repeat(len(flight.coef), axis=0)
    off = replace(flight, coef=one, lights=replace(flight.lights, colors=np.zeros_like(flight.lights.colors)))
    brightest = night((off,), 27.5, behind).max()
    assert 0 < brightest <= UNLIT_GREY_LEVEL


@pytest.mark.slow
def test_no_time_is_written_over_the_lights_of_a_small_frame() -> None:
    plan = show_flights.plan()
    ways = [as_minutes(time) for board in boards(plan) for moment in board.moments for time in moment.way]
    with texts() as found:
        (artifact,) = EMITTER.emit(plan).artifacts
    page = np.asarray(Image.open(BytesIO(artifact.data)).convert("L")).astype(int)
    times = [t for t in found if t.text in ways and t.style.color == QUIET]
    assert sorted(t.text for t in times) == sorted(ways)
    for t in times:
        dots = page.shape[1] / WIDTH_IN
        rows = slice(page.shape[0] - round(t.box.top * dots), page.shape[0] - round(t.box.y * dots))
        assert (
            page[rows, round(t.box.x * dots) : round(t.box.right * dots)].min() > 60
        )  # ink on paper, no night
    assert min(t.capital for t in times) >= 9.0 - 1e-9


@pytest.mark.long
def test_the_map_has_relief_with_heights_and_the_houses_that_stand_there() -> None:
    level = EMITTER.emit(show_flights.plan()).artifacts[0].data
    ground = terrain(ridge(60.0, at=25.0))
    with texts() as found:
        relief = EMITTER.emit(show_flights.plan(show_flights.mission(terrain=ground))).artifacts[0].data
    here = [t for t in found if t.box.x < MARGIN_IN + MAP_IN]
    heights = [t for t in here if t.text.endswith(" m") and t.text.removesuffix(" m").isdigit()]
    assert heights
    assert any("contours" in t.text for t in here)
    assert min(t.capital for t in heights) >= 9.0 - 1e-9
    for one in heights:
        assert not [other.text for other in here if other is not one and one.box.meets(other.box)]
    built = show_flights.mission(meshes=(house((20.0, 20.0, 5.0), (20.0, 20.0, 10.0)),))
    houses = EMITTER.emit(show_flights.plan(built)).artifacts[0].data
    assert stone(houses) > stone(level) + 500
    assert (pixels(relief) != pixels(level)).any(axis=-1).sum() > 5000


def pixels(data: bytes) -> np.ndarray:
    return np.asarray(Image.open(BytesIO(data)).convert("RGB")).astype(int)


def stone(data: bytes) -> int:
    """Return how many pixels have the colour of houses, below the audience's fan or beside it."""
    page = pixels(data) / 255.0
    fan = np.array(STONE) + 0.13 * (np.array(CAMERA) - np.array(STONE))
    return sum(int((np.abs(page - color).max(axis=-1) < 0.02).sum()) for color in (np.array(STONE), fan))
