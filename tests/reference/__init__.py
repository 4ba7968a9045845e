"""Programs that compute reference solutions, and the trajectories of the planar model."""
