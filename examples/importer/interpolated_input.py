"""fmi2SetRealInputDerivatives: a cubic torque in one step of 1 s is the same as in a thousand; a held value is not."""

from unit import read, references, verdict, wheel


def lean(steps: int, orders: int) -> float:
    unit = wheel()
    for t in (i / steps for i in range(steps)):
        unit.setReal(references("M_3"), [1 + t - 2 * t**2 + t**3])
        slopes = [1 - 4 * t + 3 * t**2, -4 + 6 * t, 6.0]
        if orders:
            unit.setRealInputDerivatives(references("M_3") * orders, range(1, 1 + orders), slopes[:orders])
        unit.doStep(t, 1 / steps)
    return read(unit, "theta")[0]


apart, held = abs(lean(1, 3) - lean(1000, 3)), abs(lean(1, 0) - lean(1000, 3))
verdict(apart < 1e-7 and held > 1e-4, f"one step and a thousand are {apart:.0e} rad apart, a held torque {held:.0e}")
