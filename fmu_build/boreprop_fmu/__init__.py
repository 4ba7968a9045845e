"""The model as an FMI 2.0 co-simulation FMU, and FMUs driven through fmpy."""
