"""The benchmark of docs/benchmark.md: its problems as data, and the programs of this project against its values."""
