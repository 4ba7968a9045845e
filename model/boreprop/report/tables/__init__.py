"""Results in tables and sentences: one module for each analysis."""
