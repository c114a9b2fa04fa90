"""Where the process of a command starts: ``shotc``, or ``python -m shotc``."""

from __future__ import annotations

import gc
import os
import sys
from contextlib import suppress

INTERRUPTED = 130


def main() -> None:
    """Run the command line of this process, and end the process."""
    # Most of a short run is imports, and they make no garbage: there is nothing
    # to collect on the way nor at the end. Pydantic need not look for plugins either.
    gc.set_threshold(100_000, 50, 100)
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    try:
        from shotc.cli.app import run  # noqa: PLC0415  after the above, for it imports the most

        code = run(sys.argv[1:])
    except KeyboardInterrupt:  # before the command line is there to tell it
        sys.stderr.write("interrupted\n")
        code = INTERRUPTED
    gc.freeze()
    if code == INTERRUPTED or "numpy" not in sys.modules:
        # What needs no numpy leaves nothing to close, and taking a process apart takes as long as a
        # pass. After an interrupt `python -m` would end as if killed, where that met code made at
        # run time (a dataclass, say), caught or not.
        for stream in (sys.stdout, sys.stderr):
            with suppress(OSError, ValueError):
                stream.flush()
        os._exit(code)
    sys.exit(code)


if __name__ == "__main__":
    main()
