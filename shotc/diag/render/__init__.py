"""Renderers of diagnostics, one module a format."""
