"""The model itself. Standard library only, relative imports only: this package travels inside the FMU."""
