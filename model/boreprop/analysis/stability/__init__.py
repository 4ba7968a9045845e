"""Local stability of straight holes: the roots of each mode, and the ηΠ at which it becomes stable."""
