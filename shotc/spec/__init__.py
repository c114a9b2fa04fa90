"""The mission as written: pydantic models and units at the door."""
