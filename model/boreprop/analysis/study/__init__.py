"""Studies of many cases: how the cases are chosen, computed and kept."""
