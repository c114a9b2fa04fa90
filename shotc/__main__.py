"""``python -m shotc`` is the command ``shotc``."""

from __future__ import annotations

from shotc.cli.app import main

if __name__ == "__main__":
    main()
