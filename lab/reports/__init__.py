"""Measured reports: tables, figures with bounds, pages."""
