"""What ./scripts/run draws, and the look of every picture; nothing here computes dynamics."""
