"""The compiler's passes, one module each."""
