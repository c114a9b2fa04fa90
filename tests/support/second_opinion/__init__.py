"""A second verifier, of the files alone.

It reads the mission's YAML and what ``plan`` and ``emit`` write, by the pages ``outputs.md`` and
``language.md``, with SciPy, PyYAML and pymap3d. It shares no code with the compiler: it looks at dense
samples where the compiler proves bounds, and projects rims of cylinders point by point where the compiler has
formulas. What both say must agree. ``test_independence.py`` holds it to that.
"""
