"""The model of borehole propagation, its runs and files. Start with `case.load_case` and `simulation.simulate`."""
