"""The wheel by other programs and methods."""
