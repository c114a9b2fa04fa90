"""Names by which a shot says that it does something on purpose (``Shot.allow``), as planning asks for."""

from shotc.ir.mission import Shot

HIDDEN = "hidden-subject"
FAST_PAN = "fast-pan"
SOFT = "soft-subject"
BLURRED = "motion-blur"


def hidden_on_purpose(shot: Shot) -> bool:
    """Tell whether a shot's target may be hidden: by its own word, or because it is to be revealed."""
    return HIDDEN in shot.allow or shot.promise.reveal is not None
