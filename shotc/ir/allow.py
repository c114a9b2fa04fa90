"""Names by which a shot says that it does something on purpose (``Shot.allow``), as planning asks for."""

HIDDEN = "hidden-subject"
FAST_PAN = "fast-pan"
