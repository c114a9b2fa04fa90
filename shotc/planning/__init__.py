"""Planning: from missions to curves. No diagnostic is made here; a fault is a value that a pass explains."""
