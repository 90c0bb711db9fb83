"""Commands of lab/site."""
