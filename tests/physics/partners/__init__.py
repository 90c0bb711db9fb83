"""The wheel coupled with other FMUs: the examples of docs/examples."""
