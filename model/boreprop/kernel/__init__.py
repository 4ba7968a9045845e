"""The core written in C, for FMUs that need no Python and for `simulate(case, engine="native")`."""
