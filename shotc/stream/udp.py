"""Non-blocking UDP sockets."""

from __future__ import annotations

import socket
from collections.abc import Iterator

from shotc.stream.endpoint import Endpoint

LARGEST_DATAGRAM_BYTES = 4096
MOST_DATAGRAMS = 200
"""Read per call, so that a sender of too much data cannot delay the flight."""


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
