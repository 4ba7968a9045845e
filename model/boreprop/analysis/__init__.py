"""Analyses of the model: numpy and scipy."""
