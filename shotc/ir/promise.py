"""The promises of a shot about its picture. Plain Python."""

from typing import NamedTuple

from shotc.ir.limits import Range


class Promise(NamedTuple):
    """The promises of a shot (``require``), which verification checks; None promises nothing.

    in_frame : share of samples with the whole target in frame, 0 to 1
    screen_error : largest distance to the reference on screen, (u, v) units
    size : (lowest, highest) projected height over frame height
    visible : least free share of the target's outline in any frame, 0 to 1
    reveal : bounds on the free share in the first and the last frame: at most the smaller bound where the
        target is hidden, at least the larger one where it is shown
    """

    in_frame: float | None = None
    screen_error: float | None = None
    size: Range | None = None
    visible: float | None = None
    reveal: Range | None = None
