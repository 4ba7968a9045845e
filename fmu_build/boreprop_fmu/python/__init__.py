"""The slave that runs inside the FMU on pythonfmu's runtime."""
