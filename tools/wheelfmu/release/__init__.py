"""One FMU with the libraries of all platforms, and its release."""
