"""Addresses of vehicles: ``udp:PORT`` listens on a port, ``udpout:HOST:PORT`` sends first.

Their sockets do not block.
"""

from __future__ import annotations

import socket
from collections.abc import Iterator
from typing import NamedTuple

EVERYWHERE = "0.0.0.0"
LARGEST_PORT = 65535
LARGEST_DATAGRAM_BYTES = 4096
MOST_DATAGRAMS = 200
"""Read per call, so that a sender of too much data cannot delay the flight."""


class Endpoint(NamedTuple):
    """A UDP address; calls : whether it is the remote address, to which the first datagram is sent."""

    host: str
    port: int
    calls: bool

    def __str__(self) -> str:
        """Return the address in the form that users write."""
        if self.calls:
            return f"udpout:{self.host}:{self.port}"
        return f"udp:{self.port}" if self.host == EVERYWHERE else f"udp:{self.host}:{self.port}"


def endpoint(text: str) -> Endpoint:
    """Parse ``udp:[HOST:]PORT`` or ``udpout:HOST:PORT``.

    Raises ValueError, which says what is wrong with the text.
    """
    scheme, _, rest = text.partition(":")
    host, _, port = rest.rpartition(":")
    if scheme not in ("udp", "udpout") or not port:
        raise ValueError(f"`{text}` is no address; write `udp:PORT`, `udp:HOST:PORT` or `udpout:HOST:PORT`")
    if not port.isascii() or not port.isdigit() or not 1 <= int(port) <= LARGEST_PORT:
        raise ValueError(f"`{text}` has no port from 1 to {LARGEST_PORT}")
    if scheme == "udpout" and not host:
        raise ValueError(f"`{text}` does not say whom to call; write `udpout:HOST:{port}`")
    return Endpoint(host or EVERYWHERE, int(port), scheme == "udpout")


def opened(endpoint: Endpoint) -> socket.socket:
    """Return a socket, bound to the address unless the address is remote.

    Raises OSError if it cannot be opened.
    """
    endpoint_socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    endpoint_socket.setblocking(False)
    try:
        if not endpoint.calls:
            endpoint_socket.bind((endpoint.host, endpoint.port))
    except OSError:
        endpoint_socket.close()
        raise
    return endpoint_socket


def datagrams(of: socket.socket) -> Iterator[tuple[bytes, tuple[str, int]]]:
    """Yield the datagrams that have arrived, with their sender, until none is left or the remote port is
    closed.
    """
    for _ in range(MOST_DATAGRAMS):
        try:
            yield of.recvfrom(LARGEST_DATAGRAM_BYTES)
        except OSError:
            return
