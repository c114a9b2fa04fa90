"""Receives the position of a live target by UDP, as JSON or MAVLink.

One datagram holds one position. In JSON it is ``{"x": .., "y": .., "z": ..}``, metres in the mission's frame,
or ``{"lat": .., "lon": .., "alt": ..}``, degrees and metres above sea level. Without a height, the target has
its planned height. In MAVLink it is the GLOBAL_POSITION_INT of another vehicle.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from math import isfinite

from shotc.geom.geodetic import to_world
from shotc.geom.vec import Vec3
from shotc.ir.mission import GeoOrigin
from shotc.stream.endpoint import Endpoint, datagrams, opened
from shotc.stream.messages import GlobalPosition, GlobeFix

STALE_S = 1.0
"""If the last position is older than this, the target's planned position is used."""
FARTHEST_M = 1e5
"""Positions farther than this from the mission's origin are ignored."""
Spot = tuple[float, float, float | None]
"""x, y and optionally z in the world frame, m."""
Decode = Callable[[bytes], Iterable[object]]


class Feed:
    """The positions of one target."""

    def __init__(self, target: str, endpoint: Endpoint, origin: GeoOrigin, mavlink: Decode) -> None:
        """Open the socket and listen.

        mavlink : decodes datagrams that are not JSON
        Raises OSError if the port cannot be opened.
        """
        self.target = target
        self.endpoint = endpoint
        self.seen: float | None = None
        self.heard = self.unread = 0
        self._origin: Vec3 = (origin.lat_deg, origin.lon_deg, origin.alt)
        self._mavlink = mavlink
        self._spot: Spot | None = None
        self._socket = opened(endpoint)

    def close(self) -> None:
        """Stop listening."""
        self._socket.close()

    def listen(self, now: float) -> None:
        """Read all datagrams that have arrived; the last position counts."""
        for data, _ in datagrams(self._socket):
            for spot in self._spots(data):
                self._spot, self.seen, self.heard = spot, now, self.heard + 1

    def position(self, now: float) -> Spot | None:
        """Return the target's position, None if none arrived in the last STALE_S seconds."""
        if self.seen is None or now - self.seen > STALE_S:
            return None
        return self._spot

    def _spots(self, data: bytes) -> list[Spot]:
        if data.lstrip().startswith(b"{"):
            spot = self._of_json(data)
            spots = [] if spot is None else [spot]
            self.unread += not spots
            return spots
        places = [m.place for m in self._mavlink(data) if isinstance(m, GlobalPosition)]
        return [spot for place in places if (spot := self._of_place(place)) is not None]

    def _of_json(self, data: bytes) -> Spot | None:
        try:
            message = json.loads(data)
        except (ValueError, RecursionError):
            return None
        lat, lon = _number(message.get("lat")), _number(message.get("lon"))
        if lat is not None and lon is not None:
            alt = _number(message.get("alt"))
            spot = self._of_place(GlobeFix(lat, lon, self._origin[2] if alt is None else alt))
            return None if spot is None else (spot[0], spot[1], None if alt is None else spot[2])
        x, y = _number(message.get("x")), _number(message.get("y"))
        return None if x is None or y is None else _near((x, y, _number(message.get("z"))))

    def _of_place(self, place: GlobeFix) -> Spot | None:
        return _near(to_world((place.lat, place.lon, place.alt), self._origin))


def _near(spot: Spot) -> Spot | None:
    return spot if all(abs(c) <= FARTHEST_M for c in spot if c is not None) else None


def _number(value: object) -> float | None:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if isfinite(number) else None
