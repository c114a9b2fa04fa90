"""The formats of meshes, point clouds and recorded flights by file ending. Plain Python, no numpy."""

from typing import Literal, NamedTuple


class Ending(NamedTuple):
    """The conventions of a format's coordinates.

    up : the axis that points up in the programs that write it
    metres : whether they are in metres; else the unit is unknown
    """

    up: Literal["y", "z"]
    metres: bool = False


ENDINGS = {
    "glb": Ending("y", metres=True),
    "ply": Ending("z"),
    "obj": Ending("y"),
    "stl": Ending("z"),
    "xyz": Ending("z"),
    "las": Ending("z"),
    "laz": Ending("z"),
}

FLIGHT_ENDINGS = (".zip", ".skyc")
"""Of recorded flights of a whole fleet."""

METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0, "ft": 0.3048, "in": 0.0254}
"""Metres of a unit."""


def ending_of(name: str) -> str:
    """Return the ending of a file's name, in lower case."""
    return name.rsplit(".", 1)[-1].lower()
