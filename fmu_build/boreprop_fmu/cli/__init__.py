"""The command `boreprop-fmu`."""
