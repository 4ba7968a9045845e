"""The command `boreprop`."""
