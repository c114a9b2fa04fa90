"""Opens the real sockets of a session: UDP and MAVLink."""

from __future__ import annotations

from collections.abc import Iterable

from shotc.ir.mission import GeoOrigin
from shotc.stream.autopilots import Autopilot
from shotc.stream.endpoint import Endpoint
from shotc.stream.feed import Feed
from shotc.stream.link import VehicleLink, decoded, decoder, understood
from shotc.stream.session import Doors


def _link(endpoint: Endpoint, autopilot: Autopilot) -> VehicleLink:
    return VehicleLink(endpoint, bytewise=autopilot.bytewise)


def _feed(target: str, endpoint: Endpoint, origin: GeoOrigin) -> Feed:
    mav = decoder()

    def positions(data: bytes) -> Iterable[object]:
        return [understood(raw) for raw in decoded(mav, data)]

    return Feed(target, endpoint, origin, positions)


DOORS = Doors(_link, _feed)
