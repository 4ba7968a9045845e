"""The core once more, in C: for FMUs that need no Python, and for `simulate(case, engine="native")`."""
