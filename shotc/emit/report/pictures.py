"""Drawings of the report as SVG: a map of the site, and a plot over time."""

from __future__ import annotations

from html import escape
from math import floor, log10

import numpy as np

from shotc.emit.report.nearness import Nearness
from shotc.emit.site.volumes import AreaOutline, Volumes
from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.rings import ground_plan
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import body_prisms

WIDTH_PX, MAP_HEIGHT_PX, PLOT_HEIGHT_PX = 680.0, 460.0, 190.0
MARGIN_SHARE = 0.05
LEFT_PX, RIGHT_PX, BOTTOM_PX, TOP_PX = 46.0, 12.0, 30.0, 12.0


def site_map(mission: MissionIR, volumes: Volumes) -> str:
    """Return the map with volumes, buildings, zones, pads, audiences and a scale bar, North up."""
    seats = [display.viewpoint for display in mission.displays if display.viewpoint is not None]
    zones = [(zone, ground_plan(zone.solid)) for zone in mission.zones]
    risk = volumes.risk.corners
    seen = np.concatenate([risk, *(np.array([seat[:2]]) for seat in seats)])
    low, high = seen.min(axis=0), seen.max(axis=0)
    scale = (1.0 - 2.0 * MARGIN_SHARE) * min(WIDTH_PX / (high - low)[0], MAP_HEIGHT_PX / (high - low)[1])
    middle = (low + high) / 2.0

    def put(points: Array) -> Array:
        flat = (points - middle) * scale
        return np.column_stack([WIDTH_PX / 2.0 + flat[:, 0], MAP_HEIGHT_PX / 2.0 - flat[:, 1]])

    def area(outline: AreaOutline, kind: str) -> str:
        return f'<polygon class="{kind}" points="{_points(put(outline.corners))}"/>'

    parts = [
        area(volumes.risk, "risk"),
        area(volumes.contingency, "contingency"),
        area(volumes.flight, "flight"),
    ]
    solids = [prism for mesh in mission.meshes for prism in body_prisms(mesh)]
    parts += [f'<polygon class="house" points="{_points(put(ground_plan(each)))}"/>' for each in solids]
    for zone, corners in zones:
        parts.append(f'<polygon class="zone {zone.keep}" points="{_points(put(corners))}"/>')
        x, y = put(corners).mean(axis=0)[0], put(corners)[:, 1].min() - 4.0
        if 0.0 < x < WIDTH_PX and 0.0 < y < MAP_HEIGHT_PX:
            parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="middle">{escape(zone.name)}</text>')
    pads = [pad for fleet in mission.fleets for pad in fleet.pads] + [d.home for d in mission.drones]
    parts += [
        f'<rect class="pad" x="{x - 1:.1f}" y="{y - 1:.1f}" width="2" height="2"/>'
        for x, y in put(np.array(pads)[:, :2]).tolist()
    ]
    for seat in dict.fromkeys(seats):
        ((x, y),) = put(np.array([seat[:2]])).tolist()
        parts.append(f'<circle class="seat" cx="{x:.1f}" cy="{y:.1f}" r="4"/>')
        parts.append(f'<text x="{x + 7:.1f}" y="{y + 4:.1f}">audience</text>')
    return _svg(MAP_HEIGHT_PX, [*parts, *_scale(scale), _north()], "Map of the site, North up")


def _scale(scale: float) -> list[str]:
    """Return a scale bar of a round length.

    scale : pixels a metre
    """
    rough = 0.25 * WIDTH_PX / scale
    unit = 10.0 ** floor(log10(rough))
    length = max(k * unit for k in (1, 2, 5) if k * unit <= rough)
    y = MAP_HEIGHT_PX - 14.0
    return [
        f'<path class="axis" d="M12 {y - 4} V{y} H{12 + length * scale:.1f} v-4"/>',
        f'<text x="{20 + length * scale:.1f}" y="{y + 1}">{length:g} m</text>',
    ]


def _north() -> str:
    x = WIDTH_PX - 20.0
    return f'<path class="north" d="M{x} 10 l6 20 l-6 -4 l-6 4 z"/><text x="{x - 4}" y="44">N</text>'


def nearness_plot(pair: Nearness) -> str:
    """Return the plot of the nearest pair's distance over time, with the separation."""
    end = float(pair.times[-1]) or 1.0
    most = 1.15 * max(float(np.median(pair.distances)), 2.0 * pair.needed)
    across, up = (WIDTH_PX - LEFT_PX - RIGHT_PX) / end, (PLOT_HEIGHT_PX - TOP_PX - BOTTOM_PX) / most

    def put(times: Array, values: Array) -> Array:
        return np.column_stack(
            [LEFT_PX + times * across, PLOT_HEIGHT_PX - BOTTOM_PX - np.minimum(values, most) * up]
        )

    floor_y = PLOT_HEIGHT_PX - BOTTOM_PX
    ((_, needed_y),) = put(np.zeros(1), np.array([pair.needed])).tolist()
    parts = [f'<path class="axis" d="M{LEFT_PX} {TOP_PX} V{floor_y} H{WIDTH_PX - RIGHT_PX}"/>']
    for time in _ticks(end):
        x = LEFT_PX + time * across
        parts.append(f'<path class="axis" d="M{x:.1f} {floor_y} v4"/>')
        parts.append(f'<text x="{x:.1f}" y="{floor_y + 17}" text-anchor="middle">{time:g} s</text>')
    for value in _ticks(most):
        y = floor_y - value * up
        parts.append(f'<path class="grid" d="M{LEFT_PX} {y:.1f} H{WIDTH_PX - RIGHT_PX}"/>')
        parts.append(f'<text x="{LEFT_PX - 5}" y="{y + 4:.1f}" text-anchor="end">{value:g} m</text>')
    parts.append(f'<path class="needed" d="M{LEFT_PX} {needed_y:.1f} H{WIDTH_PX - RIGHT_PX}"/>')
    label = f'y="{needed_y + 13:.1f}" text-anchor="end">kept: {pair.needed:g} m</text>'
    parts.append(f'<text x="{WIDTH_PX - RIGHT_PX - 4}" {label}')
    parts.append(f'<polyline class="curve" points="{_points(put(pair.times, pair.distances))}"/>')
    return _svg(PLOT_HEIGHT_PX, parts, f"Nearest pair of {pair.fleet} over time")


def _ticks(most: float) -> list[float]:
    unit = 10.0 ** floor(log10(most / 5.0))
    step = next(k * unit for k in (1, 2, 5, 10) if most / (k * unit) <= 8.0)
    return [round(k * step, 9) for k in range(int(most / step) + 1)]


def _points(points: Array) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points.tolist())


def _svg(height: float, parts: list[str], title: str) -> str:
    head = f'<svg viewBox="0 0 {WIDTH_PX:g} {height:g}" role="img" xmlns="http://www.w3.org/2000/svg">'
    return "\n".join([head, f"<title>{escape(title)}</title>", *parts, "</svg>"])
