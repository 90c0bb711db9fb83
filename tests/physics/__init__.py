"""Physics of the built FMU: every motion here comes out of wheel.fmu, through fmpy."""
