"""A mission of a seed: who is filmed, by whom, from where, and what stands around."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import yaml

from tests.support.generated import framings, moving, standing, surroundings
from tests.support.generated.cameras import Camera, camera
from tests.support.generated.dice import Dice
from tests.support.generated.subjects import MOVING, STANDING, Subject
from tests.support.generated.subjects import beside as subject_beside
from tests.support.generated.subjects import moving as moving_subject
from tests.support.generated.subjects import standing as standing_subject
from tests.support.generated.takes import PLACES, Array, Rules, Take, least_time

TRIES = 400
FILMED = 34.0  # mission time, seconds, about which what moves is filmed first
SETTLING = 9.0  # seconds beside twice the straight way, before every shot
NEARER_HALF = 0.5  # of a drone's speed that what it films goes at, at most
THEMES = {"standing": 4.0, "moving": 4.0, "together": 2.0, "statues": 1.0, "landmark": 1.0}


class Mission(NamedTuple):
    """A mission as it is drawn; files : by name, beside it."""

    seed: int
    theme: str
    text: str
    files: dict[str, bytes]
    takes: tuple[Take, ...]
    cameras: tuple[Camera, ...]


def mission(seed: int, most_drones: int = 4, most_takes: int = 3) -> Mission:
    """Return the mission of a seed; it depends on nothing else."""
    for attempt in range(TRIES):
        found = _drawn(Dice(f"{seed}/{most_drones}/{most_takes}/{attempt}"), seed, most_drones, most_takes)
        if found is not None:
            return found
    raise AssertionError(f"no mission for seed {seed} in {TRIES} tries")


class _Cast(NamedTuple):
    """What a mission is made of before its shots are drawn."""

    dice: Dice
    rules: Rules
    cameras: tuple[Camera, ...]
    subjects: tuple[Subject, ...]
    most_takes: int


def _drawn(dice: Dice, seed: int, most_drones: int, most_takes: int) -> Mission | None:
    theme = dice.weighted(THEMES)
    count = min(most_drones, dice.weighted({1: 4.5, 2: 3.0, 3: 1.5, 4: 1.0}))
    count = max(count, 2) if theme == "landmark" and most_drones > 1 else count
    wind = dice.between(0.5, 2.5, 1) if dice.chance(0.25) else 0.0
    cameras = _cameras(dice, count, wind)
    subjects = _subjects(dice, theme, cameras)
    rules = _rules(dice, subjects, count)
    cast = _Cast(dice, rules, cameras, subjects, max(1, min(most_takes, 4 - count)))
    takes = _takes(cast, theme)
    if takes is None or not _fit_together(cast, takes):
        return None
    pads = _pads(cast, takes)
    if pads is None or not all(_in_time(c, p, takes) for c, p in zip(cameras, pads, strict=True)):
        return None
    tree = _tree(cast, seed, takes, pads, wind)
    text = yaml.safe_dump(_plain(tree), sort_keys=False, default_flow_style=None, width=110)
    files = {name: data for s in subjects for name, data in s.files.items()}
    return Mission(seed, theme, text, files, takes, cameras)


def _cameras(dice: Dice, count: int, wind: float) -> tuple[Camera, ...]:
    prioritised = count > 1 and dice.chance(0.6)
    found: list[Camera] = []
    alike = dice.chance(0.3)
    for i in range(count):
        priority = i + 1 if prioritised else None
        if alike and found:
            wanted = found[0].wanted | ({"priority": priority} if priority else {})
            found.append(found[0]._replace(name=f"cam{i + 1}", wanted=wanted))
        else:
            found.append(camera(dice, f"cam{i + 1}", wind, priority))
    return tuple(found)


def _subjects(dice: Dice, theme: str, cameras: tuple[Camera, ...]) -> tuple[Subject, ...]:
    if theme in ("standing", "statues"):
        sort = dice.pick(("person", "statue") if theme == "statues" else list(STANDING))
        first = standing_subject(dice, sort, sort, (0.0, 0.0))
        others = dice.whole(1, 2) if theme == "statues" else dice.weighted({0: 3, 1: 1})
        return (first, *(_another(dice, first, i, theme) for i in range(others)))
    fastest = moving.SPEED * NEARER_HALF / 0.72 * min(c.speed for c in cameras)
    sort = dice.pick(("walker", "runner", "rider", "boat") if theme == "together" else list(MOVING))
    first = moving_subject(dice, sort, sort, fastest, FILMED)
    if theme == "together":
        return (first, *(_companion(dice, first, sort, i) for i in range(dice.whole(1, 2))))
    if theme == "landmark":
        far, course = dice.between(130, 180), float(first.course(FILMED))
        at = dice.sign() * far * np.array([-np.sin(course), np.cos(course)])
        sort = dice.pick(list(STANDING))
        return (first, standing_subject(dice, sort, sort, (at[0], at[1])))
    return (first,)


def _another(dice: Dice, first: Subject, i: int, theme: str) -> Subject:
    if theme == "statues":
        sort, far = dice.pick(("person", "statue")), dice.between(1.0, 4.0)
    else:
        sort, far = dice.pick(("statue", "oak", "barn")), dice.between(20.0, 60.0)
    angle = np.radians(dice.whole(0, 359) if i == 0 else 0) + np.pi * i
    drawn = standing_subject(dice, sort, f"{sort}{i + 2}", (0.0, 0.0))
    at = (first.radius + drawn.radius + far) * np.array([np.cos(angle), np.sin(angle)])
    centre = [round(float(at[0]), 2), round(float(at[1]), 2), drawn.wanted["at"][2]]
    return drawn._replace(points=np.array([centre]), wanted=drawn.wanted | {"at": centre})


def _companion(dice: Dice, first: Subject, sort: str, i: int) -> Subject:
    angle = np.radians(dice.whole(0, 359))
    far = (2 * first.radius + dice.between(1.0, 3.0)) * (i + 1)
    return subject_beside(
        first, dice, sort, f"{sort}{i + 2}", (far * float(np.cos(angle)), far * float(np.sin(angle)))
    )


def _rules(dice: Dice, subjects: tuple[Subject, ...], drones: int) -> Rules:
    small = min(s.height for s in subjects) < 3.0
    ground = dice.pick((0.5, 0.8, 1.0)) if small else dice.pick((1.5, 2.0, 2.0, 3.0))
    composition = dice.weighted({"center": 2, "thirds": 3, "thirds-lines": 1, "phi": 1, "left-third": 0.5})
    return Rules(ground, dice.pick((0.5, 1.0, 1.0, 2.0)), dice.pick((3.0, 3.0, 4.0, 6.0)), composition)


def _takes(cast: _Cast, theme: str) -> tuple[Take, ...] | None:
    found: list[Take] = []
    turn = cast.dice.whole(0, 359)
    for i, one in enumerate(cast.cameras):
        mine = _mine(cast, theme, i, one, turn, found)
        if not mine:
            return None
        found += mine
    return tuple(found)


def _mine(cast: _Cast, theme: str, i: int, one: Camera, turn: int, others: list[Take]) -> list[Take]:
    """Draw the shots of one drone, each so that it leaves room to those of the others."""
    dice = cast.dice
    still = theme in ("standing", "statues") or (theme == "landmark" and i % 2 == 1)
    mine: list[Take] = []
    wanted = dice.whole(1, cast.most_takes)
    for _ in range(8 * wanted):
        name = f"{'abcd'[i]}{len(mine) + 1}"
        take = _still(cast, theme, one, (turn, i), name) if still else _going(cast, theme, one, mine, name)
        if take is not None and _has_room(cast, take, one, others):
            mine.append(take)
        if len(mine) == wanted:
            break
    return mine


def _has_room(cast: _Cast, take: Take, one: Camera, others: list[Take]) -> bool:
    if not all(surroundings.apart(take, other, cast.rules) for other in others):
        return False
    if any(
        surroundings.in_between(a, b, cast.subjects)
        for other in others
        for a, b in ((take, other), (other, take))
    ):
        return False
    seen = surroundings.in_sight(take, cast.subjects)
    return seen and surroundings.clear_of_subjects(take, one, cast.subjects, cast.rules)


def _still(cast: _Cast, theme: str, one: Camera, sector: tuple[int, int], name: str) -> Take | None:
    dice, rules = cast.dice, cast.rules
    still = tuple(s for s in cast.subjects if not s.moves)
    if theme == "statues" and dice.chance(0.6):
        when = (0.0, float(dice.whole(4, 10)))
        return framings.take(dice, one, rules, still, when, name, timed=False)
    turn, i = sector
    share = 360.0 / len(cast.cameras)
    wide = 360.0 if len(cast.cameras) == 1 else max(20.0, share - 45.0)
    subject = still[0] if theme != "standing" or dice.chance(0.8) else dice.pick(still)
    return standing.take(standing.Corner(dice, one, subject, rules, turn + i * share, wide), name)


def _going(cast: _Cast, theme: str, one: Camera, mine: list[Take], name: str) -> Take | None:
    """Draw a shot of what moves, after the drone's shots before; alone it may leave its start open."""
    dice = cast.dice
    lasts = float(dice.whole(4, int(moving.LONGEST)))
    timed = len(cast.cameras) > 1 or bool(mine) or dice.chance(0.6)
    if mine and mine[-1].times is None:
        return None
    start = FILMED + dice.whole(-3, 4)
    if mine and mine[-1].times is not None:
        start = round(float(mine[-1].times[-1])) + dice.whole(10, 40)
    going = tuple(s for s in cast.subjects if s.moves)
    if theme == "together" and dice.chance(0.6):
        subjects = going[: dice.whole(2, len(going))]
        take = framings.take(dice, one, cast.rules, subjects, (start, lasts), name, timed=timed)
    elif dice.chance(0.1):
        take = framings.take(dice, one, cast.rules, going[:1], (start, lasts), name, timed=timed)
    else:
        named = cast.rules.composition if cast.rules.composition in PLACES else "center"
        named = "upper-third" if cast.rules.composition == "thirds-lines" else named
        screen = dice.pick(list(PLACES)) if dice.chance(0.2) else named
        chance = moving.Chance(dice, one, going[0], cast.rules, start, lasts, screen)
        take = moving.take(chance, name, timed=timed)
    if take is None or take.times is None or not mine or mine[-1].times is None:
        return take
    way = np.array([mine[-1].places[-1], take.places[0]])
    needed = 2 * least_time(one, way) + SETTLING
    return take if take.times[0] - mine[-1].times[-1] >= needed else None


def _fit_together(cast: _Cast, takes: tuple[Take, ...]) -> bool:
    kinds = {c.name for c in cast.cameras}
    return {t.drone for t in takes} == kinds


def _pads(cast: _Cast, takes: tuple[Take, ...]) -> list[Array] | None:
    found: list[Array] = []
    for one in cast.cameras:
        first = next(t for t in takes if t.drone == one.name)
        at = surroundings.pad(cast.dice, first, takes, found, cast.subjects, cast.rules)
        if at is None:
            return None
        found.append(at)
    return found


def _in_time(one: Camera, pad: Array, takes: tuple[Take, ...]) -> bool:
    """Tell whether a drone can be at its first shot when that begins."""
    first = next(t for t in takes if t.drone == one.name)
    if first.times is None:
        return True
    needed = 2 * least_time(one, np.array([pad, first.places[0]])) + SETTLING
    return bool(first.times[0] >= needed)


def _tree(cast: _Cast, seed: int, takes: tuple[Take, ...], pads: list[Array], wind: float) -> dict[str, Any]:
    dice = cast.dice
    world: dict[str, Any] = {"origin": {"lat": 47.05, "lon": 8.31, "alt": 430}} if dice.chance(0.6) else {}
    if wind:
        world["wind"] = f"{wind:g} m/s"
    zones = surroundings.zones(dice, takes, pads, cast.subjects, cast.cameras)
    if zones:
        world["zones"] = zones
    drones = {
        c.name: {**c.wanted, "home": [float(x) for x in p]} for c, p in zip(cast.cameras, pads, strict=True)
    }
    return {
        "shotc": 1,
        "mission": f"seed-{seed}",
        **({"world": world} if world else {}),
        "targets": {s.name: s.wanted for s in cast.subjects},
        "drones": drones,
        "rules": _written(cast),
        "shots": _shots(cast, takes),
        "output": {"rate": 25},
    }


def _shots(cast: _Cast, takes: tuple[Take, ...]) -> list[dict[str, Any]]:
    """Return the shots as they are written: some leave the drone open, some wait for another's shot."""
    shots = [dict(t.wanted) for t in takes]
    drones = {c.name: {k: v for k, v in c.wanted.items() if k != "priority"} for c in cast.cameras}
    alike = len(drones) > 1 and all(wanted == drones["cam1"] for wanted in drones.values())
    if alike and all(t.times is not None for t in takes) and cast.dice.chance(0.5):
        return [shot | {"drone": "auto"} for shot in shots]
    first, last = takes[0], takes[-1]
    if first.drone != last.drone and last.times is None and first.times is None and cast.dice.chance(0.4):
        timing = shots[-1].get("timing", {}) | {"after": first.id}
        shots[-1] = shots[-1] | {"timing": timing}
    return shots


def _written(cast: _Cast) -> dict[str, Any]:
    rules = cast.rules
    found: dict[str, Any] = {
        "composition": rules.composition,
        "ground_clearance": rules.ground,
        "target_clearance": rules.target,
    }
    if len(cast.cameras) > 1:
        found["separation"] = rules.separation
    return found


def _plain(tree: Any) -> Any:
    """Return a tree of plain values, of which no two parts are the same object."""
    if isinstance(tree, dict):
        return {key: _plain(value) for key, value in tree.items()}
    if isinstance(tree, list | tuple):
        return [_plain(value) for value in tree]
    if isinstance(tree, np.generic):
        return tree.item()
    return tree
