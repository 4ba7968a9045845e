"""The borehole model as an FMI 2.0 co-simulation FMU: `build` packs it, `drive` runs it."""
