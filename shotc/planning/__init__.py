"""Planning: missions in, curves out. No diagnostic is made here; faults are values that a pass explains."""
