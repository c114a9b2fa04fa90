"""The emitters of shows."""
