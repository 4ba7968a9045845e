"""The model itself. It imports its own modules and the standard library only, since it travels inside the FMU."""
