"""Addresses of vehicles and targets as they are written."""

from __future__ import annotations

import pytest

from shotc.stream.endpoint import Endpoint, endpoint


@pytest.mark.parametrize(
    ("text", "read"),
    [
        ("udp:14540", Endpoint("0.0.0.0", 14540, False)),
        ("udp:127.0.0.1:14540", Endpoint("127.0.0.1", 14540, False)),
        ("udpout:192.168.1.7:14550", Endpoint("192.168.1.7", 14550, True)),
    ],
)
def test_an_address_is_read_and_written_back(text, read):
    assert endpoint(text) == read
    assert str(read) == text


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("14540", "no address"),
        ("tcp:localhost:1", "no address"),
        ("udp:", "no address"),
        ("udp:far", "no port"),
        ("udp:0", "no port"),
        ("udp:65536", "no port"),
        ("udp:٣", "no port"),
        ("udpout:14550", "whom to call"),
    ],
)
def test_what_is_wrong_with_one_is_said(text, word):
    with pytest.raises(ValueError, match=word):
        endpoint(text)
