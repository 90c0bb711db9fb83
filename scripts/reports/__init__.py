"""Pieces of the scripts that write docs/results: Markdown tables, the footer, the sections of each report."""
