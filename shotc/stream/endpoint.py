"""Addresses of vehicles: ``udp:PORT`` listens on a port, ``udpout:HOST:PORT`` sends first."""

from __future__ import annotations

from typing import NamedTuple

EVERYWHERE = "0.0.0.0"
LARGEST_PORT = 65535


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
