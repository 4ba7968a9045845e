"""Straight holes: the roots of their modes, and where they lose stability."""
