"""Runs: the engines that drill, trajectories and their files."""
