"""Cases, which say what is drilled, and their files."""
