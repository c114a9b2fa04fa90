"""plan.json: write a verified plan to a file, and read it back so that it can be proved again."""
