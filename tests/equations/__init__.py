"""The equations, pointwise and through the C header: the paper, its misprints, Jacobians, symmetries, known motions."""
