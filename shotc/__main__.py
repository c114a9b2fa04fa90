"""The entry point of the process: ``shotc``, or ``python -m shotc``."""

from __future__ import annotations

import gc
import os
import sys
from contextlib import suppress

INTERRUPTED = 130


def main() -> None:
    """Run the command line of this process, and end the process."""
    # A short run consists mostly of imports, which make no garbage, so collection is not needed.
    # Pydantic need not search for plugins either.
    gc.set_threshold(100_000, 50, 100)
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    try:
        from shotc.cli.app import run  # noqa: PLC0415  after the settings above, because it imports most modules

        code = run(sys.argv[1:])
    except KeyboardInterrupt:  # during imports, before the command line handles it
        sys.stderr.write("interrupted\n")
        code = INTERRUPTED
    gc.freeze()
    if code == INTERRUPTED or "numpy" not in sys.modules:
        # Without numpy there is nothing to close, and the interpreter's shutdown takes as long as a pass.
        # If an interrupt meets code that is generated at run time (such as a dataclass), `python -m` would
        # end as if killed, even if the interrupt is caught.
        for stream in (sys.stdout, sys.stderr):
            with suppress(OSError, ValueError):
                stream.flush()
        os._exit(code)
    sys.exit(code)


if __name__ == "__main__":
    main()
