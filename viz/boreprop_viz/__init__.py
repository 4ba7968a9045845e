"""Runs drawn with Rerun."""
