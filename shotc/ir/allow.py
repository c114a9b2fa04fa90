"""Names of ``Shot.allow`` that planning reads: what a shot does on purpose."""

from shotc.ir.mission import Shot

HIDDEN = "hidden-subject"
FAST_PAN = "fast-pan"
SOFT = "soft-subject"
BLURRED = "motion-blur"


def hidden_on_purpose(shot: Shot) -> bool:
    """Return whether a shot's target may be hidden: the shot allows it, or it promises a reveal."""
    return HIDDEN in shot.allow or shot.promise.reveal is not None
