"""Packs a case as an FMU."""
