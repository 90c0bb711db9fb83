"""Vehicles made of FMUs."""
