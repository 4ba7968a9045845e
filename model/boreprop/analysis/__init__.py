"""Analyses of cases and runs."""
