"""Checks of pictures: above the ground, inside keep-in zones, clear of all else; and of their audience."""

from __future__ import annotations

from collections.abc import Iterator
from math import floor, inf

from shotc.diag.model import Diagnostic, Label
from shotc.geom.apart import spacing
from shotc.geom.solids import signed_distance
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display, Fleet, Picture
from shotc.planning.clearances import ROUNDING_M, Clearance, clearances_of
from shotc.rounding import at_least, down
from shotc.show.geom.fit import MOST_DARK_SHARE, growth, most_drones
from shotc.show.geom.shape import Ball, balls, depth_in, highest, lowest
from shotc.show.geom.sizes import enlarged, resized, size_words
from shotc.show.labels import centre_label, key_of, word_of

FARTHEST_M, MANY_PAIRS = (
    60,
    2000,
)  # largest distance of the search, metres; most pairs of balls and obstacles for it
WAYS: tuple[tuple[Vec3, str], ...] = (
    ((1.0, 0.0, 0.0), "east"),
    ((-1.0, 0.0, 0.0), "west"),
    ((0.0, 1.0, 0.0), "north"),
    ((0.0, -1.0, 0.0), "south"),
    ((0.0, 0.0, 1.0), "up"),
)


def check_pictures(mission: MissionIR, display: Display, fleet: Fleet) -> Iterator[Diagnostic]:
    """Yield the faults of each picture of a display, as far as its shape is known without a solver."""
    obstacles = clearances_of(mission, fleet)
    for picture in display.pictures:
        yield from _viewed(mission, display, fleet, picture)
        yield from _too_many(mission, fleet, picture)
        shape = balls(picture.source)
        if shape:
            yield from _too_low(mission, fleet, picture, shape)
            for obstacle in obstacles:
                yield from _against(mission, fleet, picture, shape, obstacle)


def _viewed(mission: MissionIR, display: Display, fleet: Fleet, picture: Picture) -> Iterator[Diagnostic]:
    """Yield the fault of a viewpoint inside a picture."""
    if display.viewpoint is None:
        return
    deep = depth_in(picture, display.viewpoint, fleet.apart.across)
    if deep < 0:
        return
    labels = (
        mission.origins.value((*display.path, "viewpoint")),
        mission.origins.key(key_of(picture), "the picture"),
    )
    note = f"it is {deep:.2f} m deep in the {word_of(picture)}, which shows no picture from there"
    message = f"the viewpoint of `{display.id}` is inside what it looks at"
    yield Diagnostic(
        "D013", message, labels, (note,), "put it where the audience is, outside of the pictures"
    )


def _too_many(mission: MissionIR, fleet: Fleet, picture: Picture) -> Iterator[Diagnostic]:
    """Yield the fault of a shape that cannot hold the fleet at its spacing in any arrangement."""
    most, count = most_drones(picture, fleet.apart), len(fleet.pads)
    if (1.0 - MOST_DARK_SHARE) * count <= most + ROUNDING_M:
        return  # drones without a place stay dark; planning reports how many
    where = "on" if picture.fill == "surface" else "in"
    word = word_of(picture)
    notes = (
        f"goals are {spacing(fleet.apart):.2f} m apart at least, as the separation asks for",
        f"no more than {floor(most)} fit {where} this {word}, and {fleet.words} has {count}",
    )
    factor = growth(picture, fleet.apart, count)
    centre = picture.source.centre
    larger = enlarged(picture, factor, mission.lowest(centre or (0.0, 0.0, 0.0), fleet.radius))
    labels = (
        mission.origins.key(key_of(picture)),
        _counted(mission, fleet),
    )
    help_ = (
        f"make it at least {at_least(factor, 1)} times as large "
        f"(`{size_words(picture.source, larger.source)}`; `plan` may ask for more), or take {floor(most)} "
        f"drones or fewer{_nearer(fleet, factor)}"
    )
    yield Diagnostic("D018", f"{count} drones do not fit {where} this {word}", labels, notes, help_)


def _nearer(fleet: Fleet, factor: float) -> str:
    """Return the separation at which a shape holds a fleet that needs it ``factor`` times as large, if the
    bodies of its drones allow it.
    """
    apart = fleet.apart
    if apart.horizontal != apart.vertical or apart.margin > 0.0:
        return ""
    least = down(apart.horizontal / factor)
    return f", or write `separation: {least:.2f}`" if least >= 2.0 * fleet.radius else ""


def _counted(mission: MissionIR, fleet: Fleet) -> Label:
    """Return a label on the number of drones."""
    if fleet.key != fleet.path:
        return mission.origins.value(fleet.key, "the group")
    return mission.origins.value((*fleet.path, "count"), "the fleet")


def _too_low(
    mission: MissionIR, fleet: Fleet, picture: Picture, shape: tuple[Ball, ...]
) -> Iterator[Diagnostic]:
    over = [ball.centre[2] - ball.radius - mission.ground(*ball.centre[:2]) for ball in shape]
    deepest = min(range(len(over)), key=over.__getitem__)
    low, floor_ = over[deepest], mission.rules.over_ground(fleet.radius)
    if low >= floor_ - ROUNDING_M:
        return
    where = f"{-low:.2f} m under the ground" if low < 0 else f"{low:.2f} m over the ground"
    if mission.terrain is not None:
        x, y, _ = shape[deepest].centre
        where += f", which is z = {round(mission.ground(x, y), 2) + 0.0:g} at [{x:.1f}, {y:.1f}]"
    note = (
        f"the ground clearance of {mission.rules.ground_clearance:.2f} m and the body radius of "
        f"{fleet.radius:.2f} m need {floor_:.2f} m"
    )
    message = f"this {word_of(picture)} reaches too low: down to {where}"
    label = (centre_label(mission, picture),)
    up = float(at_least(floor_ - low))
    yield Diagnostic("D014", message, label, (note,), f"raise its centre by {up:.2f} m{_to(picture, up)}")


def _against(
    mission: MissionIR, fleet: Fleet, picture: Picture, shape: tuple[Ball, ...], obstacle: Clearance
) -> Iterator[Diagnostic]:
    """Yield the faults of a shape against one zone or target."""
    if obstacle.inside:
        yield from _inside(mission, fleet, picture, shape, obstacle)
        return
    gaps = [signed_distance(obstacle.solid, ball.centre) for ball in shape]
    swallowed = all(gap <= -ball.radius for gap, ball in zip(gaps, shape, strict=True))
    reach = max(obstacle.metres + ball.radius - gap for gap, ball in zip(gaps, shape, strict=True))
    if reach <= ROUNDING_M:
        return
    labels = (centre_label(mission, picture), mission.origins.key(obstacle.owner.path, "the obstacle"))
    what = obstacle.owner.words
    if swallowed:
        message = f"this {word_of(picture)} is inside {what}"
        help_ = _cleared(mission, fleet, picture, shape) or "move it out of there"
        yield Diagnostic("D016", message, labels, ("no drone can stand in it",), help_)
        return
    message = f"this {word_of(picture)} reaches into {what}"
    note = f"by {reach:.2f} m, the {obstacle.metres:.2f} m included that must be free"
    help_ = _cleared(mission, fleet, picture, shape) or "move it clear"
    yield Diagnostic("D017", message, labels, (note,), f"{help_}; the plan refuses drones that stand there")


def _inside(
    mission: MissionIR, fleet: Fleet, picture: Picture, shape: tuple[Ball, ...], zone: Clearance
) -> Iterator[Diagnostic]:
    """Yield the faults of a shape against a keep-in zone: its heights, and its sides as far as known."""
    labels = (centre_label(mission, picture), mission.origins.key(zone.owner.path, "the zone"))
    word = word_of(picture)
    # Below the ground clearance it is too low anyway, which is reported once.
    low = max(lowest(shape), min(mission.lowest(ball.centre, fleet.radius) for ball in shape))
    high = highest(shape)
    bottom, top = zone.solid.bottom + fleet.radius, zone.solid.top - fleet.radius
    if low < bottom - ROUNDING_M or high > top + ROUNDING_M:
        note = (
            f"it reaches from z = {low:.2f} to {high:.2f}; the zone, less the body radius of "
            f"{fleet.radius:.2f} m, from {bottom:.2f} to {top:.2f}"
        )
        message = f"this {word} reaches out of the heights of keep-in zone `{zone.owner.name}`"
        yield Diagnostic("D015", message, labels, (note,), _fitted(picture, (low, high), (bottom, top)))
        return
    walls = zone.solid._replace(bottom=-inf, top=inf)
    rooms = [-signed_distance(walls, ball.centre) - ball.radius for ball in shape]
    outside = all(distance + 2 * ball.radius <= 0 for distance, ball in zip(rooms, shape, strict=True))
    lacks = fleet.radius - min(rooms)
    if lacks <= ROUNDING_M:
        return
    if outside:
        message = f"this {word} is outside keep-in zone `{zone.owner.name}`"
        help_ = _cleared(mission, fleet, picture, shape) or "move it into the zone"
        yield Diagnostic("D015", message, labels, ("no drone can stand in it",), help_)
        return
    note = f"by {lacks:.2f} m, the body radius of {fleet.radius:.2f} m included"
    message = f"this {word} reaches out of keep-in zone `{zone.owner.name}`"
    help_ = _cleared(mission, fleet, picture, shape) or "move it inside"
    yield Diagnostic("D017", message, labels, (note,), f"{help_}; the plan refuses drones that stand there")


def _high_enough(mission: MissionIR, fleet: Fleet, shape: tuple[Ball, ...]) -> bool:
    lowest_ = ((ball.centre[2] - ball.radius, mission.lowest(ball.centre, fleet.radius)) for ball in shape)
    return all(z >= least - ROUNDING_M for z, least in lowest_)


def _cleared(mission: MissionIR, fleet: Fleet, picture: Picture, shape: tuple[Ball, ...]) -> str:
    """Return the shortest shift that clears a picture of everything, in words; empty where none is found."""
    centre, around = picture.source.centre, clearances_of(mission, fleet)
    if centre is None or len(shape) * len(around) > MANY_PAIRS:
        return ""
    for metres in range(1, FARTHEST_M + 1):
        for (x, y, z), direction in WAYS:
            by = (x * metres, y * metres, z * metres)
            there = tuple(ball._replace(centre=_plus(ball.centre, by)) for ball in shape)
            if _high_enough(mission, fleet, there) and all(is_clear(there, o, fleet.radius) for o in around):
                to = ", ".join(f"{c + 0.0:.2f}" for c in _plus(centre, by))
                return f"move it {metres} m {direction}, to `center: [{to}]`"
    return ""


def is_clear(shape: tuple[Ball, ...], obstacle: Clearance, radius: float) -> bool:
    """Return whether a shape is wholly outside of a zone or target, or wholly within a keep-in zone."""
    gaps = (signed_distance(obstacle.solid, ball.centre) for ball in shape)
    if obstacle.inside:
        return all(-gap - ball.radius >= radius - ROUNDING_M for gap, ball in zip(gaps, shape, strict=True))
    return all(
        gap - ball.radius >= obstacle.metres - ROUNDING_M for gap, ball in zip(gaps, shape, strict=True)
    )


def _plus(p: Vec3, by: Vec3) -> Vec3:
    return (p[0] + by[0], p[1] + by[1], p[2] + by[2])


def _fitted(picture: Picture, reach: tuple[float, float], free: tuple[float, float]) -> str:
    """Return how to fit a shape that reaches from one height to another between two others, metres."""
    (low, high), (bottom, top) = reach, free
    if high - low > top - bottom:
        factor = (top - bottom) / (high - low)
        smaller = resized(picture.source, lambda metres: down(metres * factor, 1))
        by = (bottom + top - low - high) / 2
        return (
            f"make it {at_least(high - low - (top - bottom))} m lower "
            f"(`{size_words(smaller, smaller)}`){_to(picture, by)}, or the zone higher"
        )
    if low < bottom:
        by = float(at_least(bottom - low))
        return f"raise it by {by:.2f} m{_to(picture, by)}"
    by = float(at_least(high - top))
    return f"lower it by {by:.2f} m{_to(picture, -by)}"


def _to(picture: Picture, by: float) -> str:
    """Return the height of a picture's centre after a move upwards, metres, as text; empty where it
    has none.
    """
    centre = picture.source.centre
    return "" if centre is None else f", to z = {round(centre[2] + by, 2):.2f}"
