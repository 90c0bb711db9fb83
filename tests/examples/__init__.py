"""The examples: vehicles made of FMUs, judged."""
