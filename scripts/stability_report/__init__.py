"""The stability report: cases as data, a driver, judges, studies and the writer of docs/results/stability.md."""
