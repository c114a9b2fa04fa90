"""A shotc emitter that writes cameras for Nuke."""
