"""fmi2GetDirectionalDerivative in co-simulation: how N changes with F_Z, against a difference quotient."""

from unit import read, references, verdict, wheel

unit = wheel()
unit.doStep(0.0, 0.5)
(slope,) = unit.getDirectionalDerivative(references("lambda_3"), references("F_Z"), [1.0])
forces = []
for F_Z in (-0.5, 0.5):
    unit.setReal(references("F_Z"), [F_Z])
    forces += read(unit, "lambda_3")
quotient = forces[1] - forces[0]
verdict(abs(slope - quotient) < 1e-9 and slope < -0.1, f"dN/dF_Z = {slope:.12f}, by differences {quotient:.12f}")
