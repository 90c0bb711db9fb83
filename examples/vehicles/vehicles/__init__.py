"""The wheel among other FMUs: partners built, coupled by a small master, and judged. See docs/vehicle.md."""
