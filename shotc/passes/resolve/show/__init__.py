"""Fleets and displays: layouts made pads, files read, and all that numbers tell of a show before planning."""

from shotc.passes.resolve.show.check import check_show
from shotc.passes.resolve.show.fleets import fleets_of
from shotc.passes.resolve.show.material import digests, not_kept, read_material

__all__ = ["check_show", "digests", "fleets_of", "not_kept", "read_material"]
