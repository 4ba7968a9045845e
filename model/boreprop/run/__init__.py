"""Runs: the engines, what a run gives, and its files."""
