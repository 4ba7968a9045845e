"""Drives an FMU through fmpy."""
