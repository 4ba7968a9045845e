"""Packs the model as an FMI 2.0 co-simulation FMU, and drives FMUs through fmpy."""
