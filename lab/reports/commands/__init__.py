"""Commands of lab/reports."""
