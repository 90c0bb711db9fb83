"""Numbers and derivations of other people, and the scenes of wheel.fmu that they are compared with."""
