"""Diagnostics as data: model, registry, renderers."""
