"""UDP sockets that never wait."""

from __future__ import annotations

import socket
from collections.abc import Iterator

from shotc.stream.endpoint import Endpoint

LARGEST_DATAGRAM_BYTES = 4096
MOST_DATAGRAMS = 200
"""At once: who sends more does not keep us from flying."""


def opened(endpoint: Endpoint) -> socket.socket:
    """Return a socket that listens where an address says so; OSError where it cannot be opened."""
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.setblocking(False)
    try:
        if not endpoint.calls:
            made.bind((endpoint.host, endpoint.port))
    except OSError:
        made.close()
        raise
    return made


def datagrams(of: socket.socket) -> Iterator[tuple[bytes, tuple[str, int]]]:
    """Yield what has come and from where, until nothing is there or the other side's port is closed."""
    for _ in range(MOST_DATAGRAMS):
        try:
            yield of.recvfrom(LARGEST_DATAGRAM_BYTES)
        except OSError:
            return
