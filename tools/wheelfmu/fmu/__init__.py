"""One FMU: its variables and what a user types for them, its driver, its files."""
