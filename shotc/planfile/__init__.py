"""plan.json: a verified plan as a file that proves itself again, and back."""
