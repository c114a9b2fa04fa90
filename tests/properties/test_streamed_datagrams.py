"""Whatever comes by UDP, nothing fails, and what is no message is none."""

from __future__ import annotations

import json
import socket

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import common as mavlink

from shotc.ir.mission import GeoOrigin
from shotc.stream.autopilots import PX4
from shotc.stream.endpoint import Endpoint
from shotc.stream.feed import FARTHEST_M, Feed
from shotc.stream.link import VehicleLink
from shotc.stream.sockets import DOORS
from shotc.stream.vehicle import VehicleStatus
from tests.support.stream.worlds import free_port

pytestmark = pytest.mark.slow

ORIGIN = GeoOrigin(47.3769, 8.5417, 408.0)
NUMBERS = (
    st.floats()
    | st.integers()
    | st.integers(10**300, 10**320)
    | st.text(max_size=3)
    | st.none()
    | st.booleans()
)
KEYS = st.sampled_from(["x", "y", "z", "lat", "lon", "alt"])
MESSAGES = st.sampled_from(sorted(mavlink.mavlink_map))


@pytest.fixture(scope="module")
def opened():
    endpoint = Endpoint("127.0.0.1", free_port(), False)
    link = VehicleLink(endpoint, bytewise=True)
    feed = DOORS.feed("tower", Endpoint("127.0.0.1", free_port(), False), ORIGIN)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        yield link, feed, sender
    link.close()
    feed.close()


def frame(number, payload, system, component):
    """Return a MAVLink 2 frame with a right checksum round any payload."""
    from pymavlink.generator.mavcrc import x25crc

    head = bytes([len(payload), 0, 0, 0, system, component]) + number.to_bytes(3, "little")
    crc = x25crc(head + payload)
    crc.accumulate(bytes([mavlink.mavlink_map[number].crc_extra]))
    return b"\xfd" + head + payload + crc.crc.to_bytes(2, "little")


FRAMES = st.builds(
    frame, MESSAGES, st.binary(min_size=1, max_size=255), st.integers(0, 255), st.integers(0, 255)
)
DATAGRAMS = st.binary(max_size=400) | FRAMES | st.lists(FRAMES, max_size=3).map(b"".join)


@given(data=st.lists(DATAGRAMS, max_size=4))
def test_a_link_takes_any_datagram(opened, data):
    link, _, sender = opened
    vehicle = VehicleStatus("cam1", PX4, link)
    for one in data:
        sender.sendto(one, ("127.0.0.1", link.endpoint.port))
    vehicle.listen(1.0)
    for name, value in vehicle.parameters.items():
        assert isinstance(name, str)
        assert isinstance(value, float)


@pytest.mark.long
@given(data=DATAGRAMS | st.dictionaries(KEYS, NUMBERS).map(lambda told: json.dumps(told).encode()))
def test_a_feed_takes_any_datagram_and_believes_only_places_near_by(opened, data):
    _, feed, sender = opened
    feed.seen = None
    sender.sendto(data, ("127.0.0.1", feed.endpoint.port))
    feed.listen(1.0)
    spot = feed.position(1.0)
    if spot is not None:
        assert all(abs(c) <= FARTHEST_M for c in spot if c is not None)


def test_a_place_in_json_is_the_place_in_mavlink(opened):
    _, feed, sender = opened
    address = ("127.0.0.1", feed.endpoint.port)
    sender.sendto(b'{"lat": 47.3779, "lon": 8.5427, "alt": 410.5}', address)
    feed.listen(1.0)
    by_json = feed.position(1.0)
    message = mavlink.MAVLink(None, srcSystem=9).global_position_int_encode(
        0, 473779000, 85427000, 410500, 0, 0, 0, 0, 0
    )
    sender.sendto(message.pack(mavlink.MAVLink(None, srcSystem=9)), address)
    feed.listen(2.0)
    assert feed.position(2.0) == pytest.approx(by_json, abs=1e-6)
    assert by_json == pytest.approx((75.5, 111.2, 2.5), abs=0.3)
    assert feed.position(3.5) is None
    assert isinstance(feed, Feed)
