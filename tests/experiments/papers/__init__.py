"""The papers' experiments on missions of our own: `make papers`."""
