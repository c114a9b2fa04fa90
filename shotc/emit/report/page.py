"""The report's page: sections of tables and drawings in self-contained HTML that prints on A4."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from html import escape
from math import degrees, isfinite
from typing import NamedTuple

import numpy as np

from shotc import __version__
from shotc.emit.report.nearness import SAMPLED_TIMES, Nearness, nearness
from shotc.emit.report.pictures import nearness_plot, site_map
from shotc.emit.report.style_sheet import STYLE
from shotc.emit.site.volumes import OFF_ACROSS_M, OFF_UPRIGHT_M, REACTION_S, Volumes, volumes
from shotc.emit.waypoints.link import link_notes, return_height
from shotc.geom.earth import of_world
from shotc.ir.measures import distinct_measures, measure
from shotc.ir.mission import MissionIR, Zone
from shotc.ir.trajectory import Claim, VerifiedIR

WAYS = {
    "bounded": "proved at every instant",
    "exact": "computed exactly",
    "sampled": "looked at at every sample",
}
GLUE = "\N{NO-BREAK SPACE}"
Row = Sequence[str]


class Simulated(NamedTuple):
    """Results of `shotc simulate`.

    flown : number and kind of the runs
    tables : each with its head as the first row
    sentences : one remark each
    """

    flown: str
    tables: Sequence[Sequence[Row]]
    sentences: Sequence[str]


def page(plan: VerifiedIR, simulated: Simulated | None = None) -> str:
    """Return the HTML document."""
    mission, site = plan.trajectory.keyframes.mission, volumes(plan.trajectory)
    near = nearness(plan.trajectory)
    sections = (
        ("Flight", _table(_facts(plan, site))),
        ("Aircraft", _table(_aircraft(mission), _AIRCRAFT)),
        ("Site", _site(mission, site)),
        ("Requirements", _requirements(plan.certificate)),
        ("Nearest pairs", _pairs(near)),
        ("On the ground", _table(_ground(plan, site))),
        ("When the link is lost", _list(_link(plan))),
        ("Wind", _list(_wind(mission, simulated)) + _flown(simulated)),
        ("Not judged", _list(_open(mission, site))),
    )
    title = f"{escape(mission.name)}: validation report"
    present = [(name, content) for name, content in sections if content]
    body = "\n".join(
        f"<section><h2>{i}. {name}</h2>\n{content}\n</section>"
        for i, (name, content) in enumerate(present, 1)
    )
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f"<title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n{_verdict(plan)}\n"
        f"{body}\n</body>\n</html>\n"
    )


def _verdict(plan: VerifiedIR) -> str:
    hard = [claim for claim in plan.certificate if claim.hard]
    held = sum(claim.holds for claim in hard)
    text = f"{held} of {len(hard)} requirements hold"
    return f'<p class="verdict">{text}, as shotc {escape(__version__)} has verified them.</p>'


def _facts(plan: VerifiedIR, site: Volumes) -> Iterator[Row]:
    flown, mission = plan.trajectory, plan.trajectory.keyframes.mission
    yield "mission", mission.name
    yield "mission file", f"SHA-256 {mission.source_sha256}"
    yield "software", f"shotc {__version__}"
    if mission.origin is None:
        yield "origin", "the mission names no place on earth"
    else:
        place = mission.origin
        yield (
            "origin",
            f"{place.lat_deg:.7f}, {place.lon_deg:.7f} deg (WGS84), {place.alt:g} m above sea level",
        )
    yield "in the air", f"{flown.end:.1f} s from the first motion to the last"
    yield "greatest height", f"{site.flight.top - site.ground:.1f} m over {site.base}, bodies included"
    far = float(np.linalg.norm(site.flight.corners, axis=1).max())
    yield "farthest from the origin", f"{far:.1f} m"


_AIRCRAFT = ("name", "model", "number", "radius", "speed", "up, down", "acceleration", "kept apart")


def _aircraft(mission: MissionIR) -> Iterator[Row]:
    for fleet in mission.fleets:
        limits, apart = fleet.limits, fleet.apart
        words = f"{apart.across:g} m across, {apart.upright:g} m upright ({apart.shape})"
        yield (
            fleet.name,
            fleet.model,
            str(len(fleet.pads)),
            f"{fleet.radius:g} m",
            f"{limits.speed:g} m/s",
            f"{limits.climb:g}, {limits.descent:g} m/s",
            f"{limits.acceleration:g} m/s²",
            words,
        )
    for drone in mission.drones:
        limits = drone.limits
        yield (
            drone.name,
            drone.model,
            "1",
            f"{drone.radius:g} m",
            f"{limits.speed:g} m/s",
            f"{limits.climb:g}, {limits.descent:g} m/s",
            f"{limits.acceleration:g} m/s²",
            f"{mission.rules.separation:g} m",
        )


def _site(mission: MissionIR, site: Volumes) -> str:
    rows = [
        ("flight geography", "hull of all flights, bodies included", site.flight),
        (
            "contingency volume",
            f"{site.across:.1f} m across and {site.upright:.1f} m upright about it",
            site.contingency,
        ),
        ("ground risk buffer", f"{site.buffer:.1f} m about that, as wide as it is high (1:1)", site.risk),
    ]
    table = _table(
        (
            (name, about, f"{outline.area:.0f} m²", _height(outline.top - site.ground))
            for name, about, outline in rows
        ),
        ("volume", "margin", "area", "height"),
    )
    zones = _table((_zone(zone) for zone in mission.zones), ("zone", "rule", "height"))
    legend = (
        '<p class="legend"><span class="flight"></span> flight geography <span class="contingency"></span> '
        'contingency volume <span class="risk"></span> ground risk buffer <span class="out"></span> zones '
        '<span class="house"></span> buildings and scenes</p>'
    )
    corners = _table(_corners(mission, site), ("fence", "latitude, deg", "longitude, deg"))
    about = (
        f"<p>Margins: {OFF_ACROSS_M:g} m for the error of the position and {OFF_UPRIGHT_M:g} m for that of "
        f"the height, {REACTION_S:g} s of reaction at the greatest allowed speed, and the stopping distance. "
        "These are proposals from assumed constants; the authority decides. The geofence is the contingency "
        "volume.</p>"
    )
    return "\n".join([site_map(mission, site), legend, table, about, corners, zones])


def _height(metres: float) -> str:
    return f"{metres:.1f} m" if metres > 0.0 else "on the ground"


def _corners(mission: MissionIR, site: Volumes) -> Iterator[Row]:
    """Yield two corners of the geofence's bounding box in latitude and longitude, for a ground station."""
    if mission.origin is None:
        return
    (west, south), (east, north) = (f(site.contingency.corners, axis=0) for f in (np.min, np.max))
    for name, x, y in (("southwest", west, south), ("northeast", east, north)):
        lat, lon, _ = of_world(np.array([[x, y, 0.0]]), mission.origin)[0].tolist()
        yield f"{name} corner of a box about it", f"{lat:.7f}", f"{lon:.7f}"


def _zone(zone: Zone) -> Row:
    rule = "all stay inside" if zone.keep == "in" else "all keep out"
    top = f"{zone.solid.top:g} m" if isfinite(zone.solid.top) else "no end"
    return zone.name, rule, f"{zone.solid.bottom:g} m to {top}"


def _requirements(certificate: Sequence[Claim]) -> str:
    parts = []
    for subject, shot in dict.fromkeys((c.subject, c.shot) for c in certificate):
        claims = [c for c in certificate if (c.subject, c.shot) == (subject, shot)]
        title = subject if shot is None else f"{subject}, shot {shot}"
        head = ("", "requirement", "asked", "worst", "at", "known by")
        parts.append(f"<h3>{escape(title)}</h3>\n{_table((_claim(c) for c in claims), head)}")
    return "\n".join(parts)


def _claim(claim: Claim) -> Row:
    worst, limit = measure(claim.worst, claim.unit), measure(claim.limit, claim.unit)
    if not claim.holds:
        worst, limit = distinct_measures(claim.worst, claim.limit, claim.unit)
    limit_text = f"{'≤' if claim.upper else '≥'} {limit}" if isfinite(claim.limit) else "no limit"
    state = (
        ("holds" if isfinite(claim.limit) else "") if claim.holds else "BROKEN" if claim.hard else "missed"
    )
    who = f"; {' and '.join(claim.drones)}" if claim.drones else ""
    return (
        state,
        claim.constraint,
        limit_text,
        worst if isfinite(claim.worst) else "no value",
        "" if claim.time is None else f"{claim.time:.1f}{GLUE}s",
        f"{WAYS[claim.method]}{who}",
    )


def _pairs(pairs: Sequence[Nearness]) -> str:
    about = (
        "<p>The distance of the nearest two drones of a fleet, in the measure of its separation (heights "
        f"scaled by their ratio), at {SAMPLED_TIMES + 1} instants. The separation is proved at every "
        "instant, also between these: see separation above.</p>"
    )
    plots = [f"<h3>{escape(each.fleet)}</h3>\n{nearness_plot(each)}" for each in pairs]
    return "\n".join([about, *plots]) if plots else ""


def _ground(plan: VerifiedIR, site: Volumes) -> Iterator[Row]:
    mission = plan.trajectory.keyframes.mission
    rules = mission.rules
    yield (
        "height of the contingency volume",
        f"{site.contingency.top - site.ground:.1f} m over {site.base}",
    )
    if rules.max_height is not None and isfinite(rules.max_height):
        yield "greatest height allowed", f"{rules.max_height:g} m above ground"
    yield "clearance from the ground", f"{rules.ground_clearance:g} m, but over the pads"
    ground = "flat ground" if mission.terrain is None else f"terrain (`{mission.terrain.file}`)"
    yield "ground", f"the mission knows {ground}"
    for mesh in mission.meshes:
        yield mesh.kind, f"`{mesh.file}`; drones keep {rules.obstacle_clearance:g} m from it"
    for target in mission.targets:
        moves = "moves" if target.track is not None else "stands"
        yield f"target {target.name}", f"{moves}; drones keep {rules.target_clearance:g} m from it"
    for display in mission.displays:
        if display.viewpoint is not None:
            direction = _from_audience(site, (display.viewpoint[0], display.viewpoint[1]))
            yield f"audience of {display.id}", direction


def _from_audience(site: Volumes, seat: tuple[float, float]) -> str:
    """Return the position of an audience relative to the volumes, in words."""
    names = ("flight geography", "contingency volume", "ground risk buffer")
    outlines = (site.flight, site.contingency, site.risk)
    for name, outline in zip(names, outlines, strict=True):
        if _beyond(outline.corners, seat) <= 0.0:
            return f"stands inside the {name}"
    return f"at least {_beyond(site.risk.corners, seat):.1f} m outside the ground risk buffer"


def _beyond(corners: np.ndarray, seat: tuple[float, float]) -> float:
    """Return a lower bound of the distance of a point from a convex outline (k, 2); at most 0 inside."""
    ahead = np.roll(corners, -1, axis=0) - corners
    out = np.stack([ahead[:, 1], -ahead[:, 0]], axis=-1) / np.linalg.norm(ahead, axis=1)[:, None]
    return float(np.sum(out * (np.array(seat) - corners), axis=1).max())


def _link(plan: VerifiedIR) -> Iterator[str]:
    mission = plan.trajectory.keyframes.mission
    if mission.fleets:
        yield (
            "Fleets: what a drone does when its link is lost is set in the show's system and in the drones; "
            "the plan does not hold it."
        )
    for track in plan.trajectory.drones:
        drone = mission.drone(track.drone)
        highest = float(track.curve.ctrl[..., 2].max()) - drone.home[2]
        yield from link_notes(drone, return_height(highest, drone.safety), written=True)


def _wind(mission: MissionIR, simulated: Simulated | None) -> Iterator[str]:
    if mission.wind:
        words = f"Planned for a wind of {mission.wind:g} m/s"
        toward = mission.wind_toward
        if toward is None:
            yield f"{words} from any side: it is subtracted from the speed limits."
        else:
            yield f"{words} from {(270.0 - degrees(toward)) % 360.0:.0f} deg: airspeed is judged."
    else:
        yield "The mission names no wind: speeds are over ground, in still air."
    if simulated is None:
        yield "Not judged here: the deviation of drones in wind and gusts. Run shotc simulate for that."


def _flown(simulated: Simulated | None) -> str:
    """Return the results of simulation; the text says that they prove nothing."""
    if simulated is None:
        return ""
    about = (
        f"<p>Flown in simulation: {escape(simulated.flown)}. A simulation proves nothing; it shows how far "
        "drones are from their plan under these assumptions.</p>"
    )
    tables = [_table(rows[1:], rows[0]) for rows in simulated.tables]
    return "\n".join(["", about, *tables, _list(simulated.sentences)])


def _open(mission: MissionIR, site: Volumes) -> Iterator[str]:
    yield "Failures of drones, of receivers and of batteries, and people who enter the site."
    yield "Deviations of drones from the plan: the margins of separation and the volumes allow for them."
    if mission.terrain is None:
        yield "The shape of the ground: it is taken to be flat."
    elif any(mission.terrain.height(float(x), float(y)) is None for x, y in site.risk.corners):
        yield f"The ground beyond `{mission.terrain.file}`, over which part of the ground risk buffer lies."


def _table(rows: Iterable[Row], head: Row = ()) -> str:
    lines = [_row(row) for row in rows]
    if not lines:
        return ""
    top = f"<thead><tr>{''.join(f'<th>{escape(cell)}</th>' for cell in head)}</tr></thead>" if head else ""
    kind = "" if head else ' class="facts"'
    return f"<table{kind}>{top}<tbody>\n" + "\n".join(lines) + "\n</tbody></table>"


def _row(row: Row) -> str:
    bad = ' class="broken"' if row[0] in ("BROKEN", "missed") else ""
    return f"<tr{bad}>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>"


def _list(items: Iterable[str]) -> str:
    return "<ul>\n" + "\n".join(f"<li>{escape(item)}</li>" for item in items) + "\n</ul>"
