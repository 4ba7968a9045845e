"""Cases: what is drilled, and the files that say so."""
