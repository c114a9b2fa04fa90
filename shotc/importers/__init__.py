"""Convert missions of other tools to missions of shotc, with a note for every assumption."""
