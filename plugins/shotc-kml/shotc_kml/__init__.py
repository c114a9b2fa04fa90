"""A shotc emitter that writes Google Earth tours."""
