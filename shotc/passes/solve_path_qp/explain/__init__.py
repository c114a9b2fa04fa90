"""The diagnostics of solve-path-qp."""
