"""Many cases: how they are chosen, computed and kept."""
