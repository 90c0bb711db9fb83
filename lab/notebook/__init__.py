"""The notebook on the rolling wheel."""
