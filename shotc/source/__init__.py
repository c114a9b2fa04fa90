"""Mission text: files, spans and the hardened YAML reader."""
