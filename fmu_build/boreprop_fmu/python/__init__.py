"""What runs inside the FMU on pythonfmu's runtime."""
