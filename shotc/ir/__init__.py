"""The compiler's intermediate representations, one module a level."""
