"""What the wheel does, measured: accuracy, stability, speed, inputs, partners. `./scripts/report` runs it."""
