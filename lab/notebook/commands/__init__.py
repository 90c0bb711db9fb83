"""Commands of lab/notebook."""
