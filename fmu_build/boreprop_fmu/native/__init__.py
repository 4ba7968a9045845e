"""What runs in a native FMU: its C code, and the binaries of it, one for each platform, which serve every case."""
