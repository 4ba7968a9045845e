"""Results in pictures: one module for each analysis."""
