"""Pictures of motions; the look of every picture of this project."""
