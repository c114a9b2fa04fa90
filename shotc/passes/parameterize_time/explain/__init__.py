"""The diagnostics of parameterize-time."""
