"""Emitters: verified plans to files."""
