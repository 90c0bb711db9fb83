"""Commands of lab/lesson."""
