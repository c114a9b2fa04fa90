"""The mission as written: pydantic models of the language, with conversion of units."""
