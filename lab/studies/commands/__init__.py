"""Commands of lab/studies."""
