"""What a shot promises of its picture. Plain Python."""

from typing import NamedTuple

from shotc.ir.limits import Range


class Promise(NamedTuple):
    """What a shot promises and verification holds it to (``require``); None promises nothing.

    in_frame : share of samples with the whole target in frame, 0 to 1
    screen_error : largest distance to the reference on screen, (u, v) units
    size : (lowest, highest) projected height over frame height
    visible : least share of the target's outline that nothing covers, in any frame, 0 to 1
    reveal : the same in the first frame and in the last: of the smaller at most, of the larger at least
    """

    in_frame: float | None = None
    screen_error: float | None = None
    size: Range | None = None
    visible: float | None = None
    reveal: Range | None = None
