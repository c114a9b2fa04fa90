"""The content of a file of waypoints: places in order, and the actions on the way."""

from __future__ import annotations

from math import inf
from typing import Literal, NamedTuple, NoReturn

from shotc.importers.cameras.places import is_place, number
from shotc.importers.cameras.takes import Refused
from shotc.importers.notes import plain
from shotc.importers.words import cut_into
from shotc.importers.xml_tree import Node

Level = Literal["home", "sea", "ground"]
"""The reference of a height: the take-off, mean sea level, or the ground below."""
LEVELS: dict[Level, str] = {"home": "the take-off", "sea": "sea level", "ground": "the ground"}
Family = Literal["mavlink", "dji", "litchi"]
MOST_POINTS = 2_000
"""Most waypoints of a file."""
UNREADABLE, FOREIGN, BROKEN, HEIGHTS, FAR, NOBODY, NOWHERE = (f"I{n:03}" for n in range(8, 15))
"""Codes of the faults of a flight's file."""


class Pace(NamedTuple):
    """Speeds in force on a leg, m/s: over ground, climbing, descending; ``along``: along the path in 3-D.

    A speed that the file does not give is infinite.
    """

    ground: float = inf
    climb: float = inf
    descent: float = inf
    along: float = inf


class FlightPoint(NamedTuple):
    """One waypoint.

    node     : its place in the file
    name     : its name for messages, such as "waypoint 3"
    lat, lon : degrees
    height   : metres above ``level``
    pace     : speeds on the leg that begins here, None if the file does not give them
    stops    : whether the drone stops here
    stay     : duration of the stop, seconds
    curve    : distance from here at which the drone begins to round the corner, metres
    straight : whether the leg to this point is straight
    pitches  : gimbal pitch angles commanded here, degrees
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

    node      : the whole file
    family    : family of the drones that fly it
    autopilot : the autopilot of a MAVLink file
    climb     : least height of the first climb, metres above the take-off
    landing   : the landing point, None if it stays in the air or the file does not give its end
    ending    : description of the flight after the last point, if the file does not give it
    pilot     : description of the pilot or autopilot that flies it
    """

    node: Node
    family: Family
    points: tuple[FlightPoint, ...]
    pilot: str
    autopilot: Literal["px4", "ardupilot"] = "px4"
    climb: float = 0.0
    landing: FlightPoint | None = None
    ending: str = ""


SWAPPED = "write the latitude from -90 to 90 deg, and the longitude from -180 to 180 deg"
"""The remedy for a place that is none on earth."""


class Unread(Exception):
    """Raised by a reader that refuses its file."""

    def __init__(self, refused: Refused) -> None:
        super().__init__(refused.message)
        self.refused = refused


def refuse(code: str, message: str, node: Node, help: str) -> NoReturn:
    """Refuse a file: raise Unread."""
    raise Unread(Refused(code, message, node, help))


def finite(text: str, what: str, node: Node) -> float:
    """Return a finite number of a file; refuse any other text. ``what``: its description for messages."""
    value = number(text)
    if value is None:
        refuse(BROKEN, f"{what} is `{plain(text, 20)}`, which is no number", node, "write a number there")
    return value


def placed(lat: float, lon: float, what: str, node: Node) -> None:
    """Refuse numbers that are not a latitude and a longitude."""
    if not is_place(lat, lon) or (lat == 0.0 and lon == 0.0):
        refuse(
            BROKEN, f"{what} is at {lat:g}, {lon:g} deg, which is no latitude and longitude", node, SWAPPED
        )


def checked(file: Waypoints) -> Waypoints:
    """Refuse a file without points, with too many, or with different references of height."""
    points = file.points
    if not points:
        refuse(BROKEN, "it holds no waypoint", file.node, "add a waypoint")
    if len(points) > MOST_POINTS:
        refuse(
            UNREADABLE,
            f"it has {len(points)} waypoints; at most {MOST_POINTS} are read",
            file.node,
            cut_into(MOST_POINTS, "waypoints"),
        )
    other = next((p for p in points if p.level != points[0].level), None)
    if other is not None:
        message = (
            f"{other.name} counts its height from {LEVELS[other.level]}, {points[0].name} from"
            f" {LEVELS[points[0].level]}"
        )
        help_ = "let all waypoints count from one level: how they fit is known at take-off only"
        refuse(HEIGHTS, message, other.node, help_)
    return file
