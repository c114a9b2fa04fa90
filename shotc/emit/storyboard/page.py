"""The storyboard's page: the layout of maps and pictures, the heading above and the certificate below."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, degrees

import numpy as np

from shotc.emit.palette import (
    CAMERA,
    FAINT,
    FLIGHT,
    GROUND_FAR,
    INK,
    KEEP_IN,
    KEEP_OUT,
    QUIET,
    SUBJECT,
    WHITE,
    shade,
)
from shotc.emit.screen import ScreenSummary, certified, percent
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, Type, house_style
from shotc.emit.storyboard.content import ShotBoard, shot_boards
from shotc.emit.storyboard.frame import Cell, caption_height, draw_frame
from shotc.emit.storyboard.furniture import round_length
from shotc.emit.storyboard.map import draw_map
from shotc.ir.hidden import HALF_SHARE
from shotc.ir.measures import OUT_OF_PICTURE, SHARES, measure
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import Claim, VerifiedIR
from shotc.rounding import as_minutes, at_least

WIDTH_IN, MARGIN_IN, GAP_IN = 16.0, 0.55, 0.28
HEADING_IN, FOOTING_IN, BAND_IN, LINE_IN = 1.40, 0.85, 0.60, 0.18
PROOF, FOOTNOTE = Type(10, INK, bold=True, across="right"), Type(10, INK)
SEPARATOR = "   ·   "
MANY_SHOTS = 4
"""Number of shots, above which pictures and maps are smaller."""


@dataclass(frozen=True, slots=True)
class ShotLayout:
    """The layout of one shot.

    map_width : of its map, inches
    picture : width and height of a picture, inches
    cell : width of a picture's cell, inches
    columns : pictures in a row
    """

    map_width: float
    picture: tuple[float, float]
    cell: float
    columns: int

    @property
    def pitch(self) -> float:
        """Height of one row of pictures with their captions, inches."""
        return self.picture[1] + caption_height(self.cell)

    def rows(self, board: ShotBoard) -> int:
        """Return the number of rows of pictures of a shot."""
        return max(1, ceil(len(board.moments) / self.columns))

    def height(self, board: ShotBoard) -> float:
        """Return the height of a shot's part of the page, inches."""
        return band_height(board) + self.rows(board) * self.pitch + 0.22


def band_height(board: ShotBoard) -> float:
    """Return the height of the text above a shot's pictures, inches; each subject has a line."""
    return BAND_IN + LINE_IN * max(0, len(board.framing) - 1)


def layout(aspect: float, shots: int) -> ShotLayout:
    """Return the layout of shots with one aspect ratio, on a page of some number of shots."""
    map_width, columns, tallest = (3.9, 3, 3.0) if shots <= MANY_SHOTS else (3.0, 4, 2.4)
    width_left = WIDTH_IN - 2 * MARGIN_IN - map_width - 0.35
    width = min((width_left + GAP_IN) / columns - GAP_IN, tallest * aspect)
    cell = max(width, 1.7)
    columns = int((width_left + GAP_IN + 1e-9) / (cell + GAP_IN))
    return ShotLayout(map_width, (width, width / aspect), cell, columns)


def draw_page(plan: VerifiedIR, dpi: float) -> bytes:
    """Return the whole storyboard as PNG bytes."""
    with house_style():
        return _page(plan, dpi)


def _page(plan: VerifiedIR, dpi: float) -> bytes:
    shots = len(plan.trajectory.keyframes.shots)
    boards = shot_boards(plan) if shots <= MANY_SHOTS else shot_boards(plan, most_generated=4)
    layouts = [layout(board.drone.aspect, shots) for board in boards]
    heights = [place.height(board) for place, board in zip(layouts, boards, strict=True)]
    footing = _footing_lines(plan.certificate, dpi)
    below = FOOTING_IN + LINE_IN * (len(footing) - 1)
    height = HEADING_IN + sum(heights) + below
    canvas = Canvas(WIDTH_IN, height, dpi)
    grid = _grid_of(boards, plan.trajectory.keyframes.mission)
    _heading(canvas, height, plan, boards, grid)
    top = height - HEADING_IN
    for place, board, used in zip(layouts, boards, heights, strict=True):
        _shot(canvas, top, (place, board), plan, grid)
        top -= used
    _footing(canvas, below, footing, headline(plan.certificate))
    return canvas.png()


def _grid_of(boards: tuple[ShotBoard, ...], mission: MissionIR) -> float:
    """Return the width of ground squares in all pictures: about two thirds of the usual height
    over ground.
    """
    poses = [m.pose for board in boards for m in board.moments]
    heights = [abs(float(pose[2]) - mission.ground(float(pose[0]), float(pose[1]))) for pose in poses]
    return max(1.0, round_length(float(np.median(heights)) / 1.5)) if heights else 10.0


def _heading(
    canvas: Canvas, height: float, plan: VerifiedIR, boards: tuple[ShotBoard, ...], grid: float
) -> None:
    mission = plan.trajectory.keyframes.mission
    legend = _legend(canvas, height - 1.08, _entries(plan, boards), grid)
    canvas.write(MARGIN_IN, height - 0.76, mission.name, Type(26, INK, bold=True), legend - 0.4 - MARGIN_IN)
    total = max((flight.curve.end for flight in plan.trajectory.drones), default=0.0)
    filmed = sum(board.end - board.start for board in boards)
    drones = ", ".join(f"{d.name} ({d.model})" for d in mission.drones)
    camera = mission.drones[0] if mission.drones else None
    facts = [
        drones,
        f"{len(boards)} shot{'' if len(boards) == 1 else 's'}",
        f"{as_minutes(total)} in the air",
        f"{as_minutes(filmed)} filmed",
    ]
    if camera is not None:
        facts.append(f"camera {degrees(camera.hfov):.0f}° hfov, {_ratio(camera.aspect)}")
    text = "   ·   ".join(facts)
    canvas.write(MARGIN_IN, height - 1.08, text, Type(11, QUIET), WIDTH_IN - 2 * MARGIN_IN)


def _ratio(aspect: float) -> str:
    for across, up in ((16, 9), (4, 3), (3, 2), (1, 1), (9, 16), (21, 9), (17, 9), (2, 1)):
        if abs(aspect - across / up) < 1e-3:
            return f"{across}:{up}"
    return f"{aspect:.2f}:1"


def _entries(plan: VerifiedIR, boards: tuple[ShotBoard, ...]) -> list[str]:
    """Return the entries of this page's legend."""
    framed = [subject for board in boards for moment in board.moments for subject in moment.framed]
    mission = plan.trajectory.keyframes.mission
    keeps = {zone.keep for zone in mission.zones}
    known = (
        ("wanted", any(subject.reference is not None for subject in framed)),
        ("actual", bool(framed)),
        ("your framing", any(subject.is_moved for subject in framed)),
        ("subject", bool(mission.targets)),
        ("keep out", "out" in keeps),
        ("keep in", "in" in keeps),
        ("shot", True),
        ("other flight", True),
    )
    return [name for name, there in known if there]


def _legend(canvas: Canvas, base: float, entries: list[str], grid: float) -> float:
    """Draw the legend at the right edge and return the position of its left end."""
    entries = [*entries, f"grid in pictures {grid:g} m"]
    style = Type(8.5, QUIET)
    widths = [canvas.extent(text, style)[0] + 0.46 for text in entries]
    x = left = WIDTH_IN - MARGIN_IN - sum(widths) + 0.16
    y = base + 0.4
    for text, width in zip(entries, widths, strict=True):
        _sign(canvas, text, x + 0.09, y + 0.045)
        canvas.text(x + 0.26, y, text, style)
        x += width
    return left


def _sign(canvas: Canvas, what: str, x: float, y: float) -> None:
    square = PageRectangle(x - 0.075, y - 0.06, 0.15, 0.12).outline()
    bar = np.array([[x - 0.1, y], [x + 0.1, y]])
    if what == "wanted":
        arms = [
            np.array([[x + sx * 0.03, y + sy * 0.03], [x + sx * 0.11, y + sy * 0.11]])
            for sx, sy in ((1, 0), (-1, 0), (0, 1), (0, -1))
        ]
        canvas.lines(arms, (*INK, 0.65), 2.8)
        canvas.lines(arms, CAMERA, 1.5)
    elif what == "actual":
        canvas.disc((x, y), 0.04, WHITE, INK, 0.9)
    elif what == "your framing":
        diamond = np.array([[x - 0.07, y], [x, y - 0.07], [x + 0.07, y], [x, y + 0.07]])
        canvas.polygons([diamond], WHITE, INK, 0.8)
    elif what == "subject":
        canvas.polygons([square], SUBJECT, shade(SUBJECT, 0.55), 0.9)
    elif what == "keep out":
        canvas.polygons([square], (*KEEP_OUT, 0.25), KEEP_OUT, 1.0)
    elif what == "keep in":
        canvas.lines([bar], (*KEEP_IN, 0.25), 3.5)
        canvas.lines([bar], KEEP_IN, 1.0, dash=(5.0, 2.0))
    elif what == "other flight":
        canvas.lines([bar], FLIGHT, 0.9, dash=(4.0, 2.5))
    elif what == "shot":
        canvas.lines([bar], INK, 2.8)
        canvas.lines([bar], CAMERA, 1.7)
    else:
        canvas.polygons([square], GROUND_FAR, FLIGHT, 0.6)


def _shot(
    canvas: Canvas, top: float, what: tuple[ShotLayout, ShotBoard], plan: VerifiedIR, grid: float
) -> None:
    place, board = what
    mission = plan.trajectory.keyframes.mission
    canvas.lines([np.array([[MARGIN_IN, top], [WIDTH_IN - MARGIN_IN, top]])], FAINT, 0.8)
    _band(canvas, top, board)
    start = top - band_height(board)
    rows = place.rows(board)
    tall = rows * place.pitch - 0.17
    draw_map(canvas, PageRectangle(MARGIN_IN, start - tall, place.map_width, tall), board, mission, grid)
    left = MARGIN_IN + place.map_width + 0.35
    for i, moment in enumerate(board.moments):
        row, column = divmod(i, place.columns)
        x = left + column * (place.cell + GAP_IN)
        y = start - row * place.pitch - place.picture[1]
        draw_frame(canvas, Cell(PageRectangle(x, y, *place.picture), place.cell), moment, mission, grid)


def _band(canvas: Canvas, top: float, board: ShotBoard) -> None:
    base = top - band_height(board) + 0.20
    end = min(
        (_framing_text(canvas, base, i, board) for i in range(len(board.framing))),
        default=WIDTH_IN - MARGIN_IN,
    )
    end -= 0.25
    x = MARGIN_IN + canvas.write(MARGIN_IN, base, board.shot.id, Type(15, INK, bold=True), 4.0) + 0.22
    text = "  ·  ".join(_facts(board))
    x += canvas.write(x, base, text, Type(9.5, QUIET), end - x - (2.8 if board.note else 0.0))
    if board.note:
        canvas.write(x + 0.25, base, board.note, Type(9.5, KEEP_OUT), end - x - 0.25)


def _framing_text(canvas: Canvas, base: float, i: int, board: ShotBoard) -> float:
    """Write the framing of one of a shot's subjects, the last subject lowest; return the left end of the
    text.
    """
    target, framing = board.framing[i]
    text = _framing(framing)
    if len(board.framing) > 1:
        text = f"{target}: {text}"
    hidden = framing.visible is not None and framing.visible < HALF_SHARE
    complete = framing.in_frame in (None, 1.0) and not hidden
    style = Type(9.5, INK if complete else KEEP_OUT, across="right")
    canvas.text(WIDTH_IN - MARGIN_IN, base + LINE_IN * (len(board.framing) - 1 - i), text, style)
    return WIDTH_IN - MARGIN_IN - canvas.extent(text, style)[0]


def _facts(board: ShotBoard) -> list[str]:
    facts = [board.shot.kind]
    facts += [board.shot.subject] if board.shot.subject else []
    facts += [f"{as_minutes(board.start)} to {as_minutes(board.end)} ({board.end - board.start:.1f} s)"]
    facts += [f"composition {board.composition}"] if board.composition else []
    if board.total is None and len(board.moments) > 1:
        facts.append(f"{len(board.moments)} moments")
    elif board.total is not None and board.total > board.numbered:
        facts.append(f"{board.numbered} of {board.total} keyframes")
    return facts


def _framing(framing: ScreenSummary) -> str:
    parts = []
    if framing.error is not None:
        parts.append(f"screen error at most {at_least(framing.error, 3)}")
    if framing.in_frame is not None:
        parts.append(f"whole subject in frame {percent(framing.in_frame)}")
    if framing.visible is not None and framing.visible < 1.0:
        parts.append(f"at least {percent(framing.visible)} of it visible")
    return "  ·  ".join(parts)


def _footing(canvas: Canvas, height: float, lines: list[str], proof: str) -> None:
    """Write the certificate in the lowest ``height`` inches of the page: lines of text, and the proof."""
    rule = height - 0.2
    canvas.lines([np.array([[MARGIN_IN, rule], [WIDTH_IN - MARGIN_IN, rule]])], FAINT, 0.8)
    first = height - FOOTING_IN + 0.42
    canvas.text(WIDTH_IN - MARGIN_IN, first, proof, PROOF)
    for i, line in enumerate(lines):
        width = _width_beside(canvas, proof) if i == 0 else WIDTH_IN - 2 * MARGIN_IN
        canvas.write(MARGIN_IN, first - LINE_IN * i, line, FOOTNOTE, width)


def _width_beside(canvas: Canvas, proof: str) -> float:
    return WIDTH_IN - 2 * MARGIN_IN - canvas.extent(proof, PROOF)[0] - 0.3


def _footing_lines(certificate: tuple[Claim, ...], dpi: float) -> list[str]:
    """Return what the certificate says of the pictures in lines that fit the page, the first beside the
    proof.
    """
    canvas = Canvas(1.0, 1.0, dpi)  # measures text: the page's height is not known before
    width = _width_beside(canvas, headline(certificate))
    lines = [""]
    for part in _footing_parts(certificate):
        longer = f"{lines[-1]}{SEPARATOR}{part}" if lines[-1] else part
        if not lines[-1] or canvas.extent(longer, FOOTNOTE)[0] <= width:
            lines[-1] = longer
        else:
            lines.append(part)
            width = WIDTH_IN - 2 * MARGIN_IN
    return lines


def _footing_parts(certificate: tuple[Claim, ...]) -> list[str]:
    whole, lost = certified(certificate), not_promised(certificate)
    parts = []
    if whole.error is not None and whole.time is not None:
        parts.append(
            f"Worst screen error {at_least(whole.error, 3)} ({whole.shot}, {as_minutes(whole.time)})"
        )
    if lost:
        parts += [f"not promised: {lost[0]}", *lost[1:]]
    elif whole.in_frame is not None:
        parts.append(f"whole subject in frame {percent(whole.in_frame)}")
    return parts


def headline(certificate: tuple[Claim, ...]) -> str:
    """Return the certificate in one line: how many hard requirements hold, and how many at every instant."""
    hard = [claim for claim in certificate if claim.hard]
    always = sum(claim.method == "bounded" for claim in hard)
    lost = sum(not claim.holds for claim in hard)
    if lost:
        return f"{lost} of {len(hard)} requirements do not hold"
    return f"All {len(hard)} requirements proved, {always} of them for every instant"


def not_promised(certificate: tuple[Claim, ...], most: int = 3) -> list[str]:
    """Return the missed claims that no shot promises, in words.

    most : largest number of claims in words; the rest is counted
    """
    words = []
    for claim in certificate:
        if claim.hard or claim.holds:
            continue
        target, _, what = claim.constraint.rpartition(" in frame")
        name = f"whole {target} in frame" if target and not what else claim.constraint
        words.append(f"{_missed(name, claim)} ({claim.shot or claim.subject})")
    return words if len(words) <= most else [*words[:most], f"{len(words) - most} more"]


def _missed(name: str, claim: Claim) -> str:
    """Return a missed claim with its worst value; a negative length or angle is said in words.

    name : of the claim
    """
    if claim.unit in SHARES:
        return f"{name} {percent(claim.worst)}"
    if claim.worst >= 0.0:
        return f"{name} {claim.worst:.3g} {claim.unit}".rstrip()
    amount, other = measure(-claim.worst, claim.unit, 2), name.removesuffix(OUT_OF_PICTURE)
    return f"{other} {amount} inside the picture" if other != name else f"{name} missed by {amount}"
