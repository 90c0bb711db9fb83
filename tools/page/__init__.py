"""Pages in three dimensions, each one file that works offline: recorded motions, or the wheel itself (docs/page.md)."""
