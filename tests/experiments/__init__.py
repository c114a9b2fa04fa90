"""Programs that measure: pytest collects nothing here."""
