"""boreprop."""
