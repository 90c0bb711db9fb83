"""Commands of lab/vehicles."""
