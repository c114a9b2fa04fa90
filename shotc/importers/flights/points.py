"""What a file of waypoints says: places in their order, and what is done on the way."""

from __future__ import annotations

from math import inf
from typing import Literal, NamedTuple, NoReturn

from shotc.importers.cameras.places import is_place, number
from shotc.importers.cameras.takes import Refused
from shotc.importers.notes import plain
from shotc.importers.xml_tree import Node

Level = Literal["home", "sea", "ground"]
"""What a height counts from: the take-off, mean sea level, or the ground below."""
LEVELS: dict[Level, str] = {"home": "the take-off", "sea": "sea level", "ground": "the ground"}
Family = Literal["mavlink", "dji", "litchi"]
MOST_POINTS = 2_000
"""How many waypoints of a file are read."""
UNREADABLE, FOREIGN, BROKEN, HEIGHTS, FAR, NOBODY, NOWHERE = (f"I{n:03}" for n in range(8, 15))
"""Codes of what is wrong with a file of a flight."""


class Pace(NamedTuple):
    """Speeds in force on a leg, m/s: over ground, climbing, descending; along : of all of these together.

    Those of which the file says nothing are infinite.
    """

    ground: float = inf
    climb: float = inf
    descent: float = inf
    along: float = inf


class FlightPoint(NamedTuple):
    """One waypoint.

    node : where it stands in its file; name : what it is there, as "waypoint 3"
    lat, lon : degrees; height : metres over ``level``
    pace : on the leg that begins here, None where the file does not say
    stops : whether the machine stands still here; stay : for so many seconds
    curve : metres from here to where a corner is rounded; straight : whether the leg to here is straight
    pitches : gimbal angles that are asked for here, degrees
    """

    node: Node
    name: str
    lat: float
    lon: float
    height: float
    level: Level
    pace: Pace | None = None
    stops: bool = False
    stay: float = 0.0
    curve: float = 0.0
    straight: bool = False
    pitches: tuple[float, ...] = ()


class Waypoints(NamedTuple):
    """A file of waypoints.

    node : of the whole file; family : of the machines that fly it; autopilot : of MAVLink's
    climb : metres over the take-off to which it climbs first at least
    landing : where it lands, None where it stays in the air or flies on by what the file does not say
    ending : what it does after its last point, in words, where that is not known
    pilot : in words, who flies it
    """

    node: Node
    family: Family
    points: tuple[FlightPoint, ...]
    pilot: str
    autopilot: Literal["px4", "ardupilot"] = "px4"
    climb: float = 0.0
    landing: FlightPoint | None = None
    ending: str = ""


class Unread(Exception):
    """Why a reader leaves its file."""

    def __init__(self, refused: Refused) -> None:
        super().__init__(refused.message)
        self.refused = refused


def refuse(code: str, message: str, node: Node, help: str = "") -> NoReturn:
    """Leave a file."""
    raise Unread(Refused(code, message, node, help))


def finite(text: str, what: str, node: Node) -> float:
    """Return a number of a file; what : it is, in words."""
    value = number(text)
    if value is None:
        refuse(BROKEN, f"{what} is `{plain(text, 20)}`, which is no number", node)
    return value


def placed(lat: float, lon: float, what: str, node: Node) -> None:
    """Refuse what is no latitude and longitude."""
    if not is_place(lat, lon) or (lat == 0.0 and lon == 0.0):
        refuse(BROKEN, f"{what} is at {lat:g}, {lon:g} deg, which is no latitude and longitude", node)


def checked(file: Waypoints) -> Waypoints:
    """Return a file of points that count their heights from one level; refuse any other."""
    points = file.points
    if not points:
        refuse(BROKEN, "it holds no waypoint", file.node)
    if len(points) > MOST_POINTS:
        refuse(UNREADABLE, f"it has {len(points)} waypoints; at most {MOST_POINTS} are read", file.node)
    other = next((p for p in points if p.level != points[0].level), None)
    if other is not None:
        message = (
            f"{other.name} counts its height from {LEVELS[other.level]}, {points[0].name} from"
            f" {LEVELS[points[0].level]}"
        )
        help_ = "let all waypoints count from one level: how they fit is known at take-off only"
        refuse(HEIGHTS, message, other.node, help_)
    return file
