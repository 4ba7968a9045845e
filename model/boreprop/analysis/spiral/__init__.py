"""Spirals: holes that wind around the vertical at a constant rate, by the equations of the model in space."""
