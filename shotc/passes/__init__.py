"""The compiler's passes, one package each."""
