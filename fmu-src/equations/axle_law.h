/* The moment of ground and brake about the axle as the law of rolling resistance gives it, tau = -(s N + brake) kappa:
 * linear in the normal force N. For the files of this folder alone. */
#ifndef WHEEL_AXLE_LAW_H
#define WHEEL_AXLE_LAW_H

#include "wheel_equations.h"

typedef struct AxleLaw {
  int held;     /* tau keeps omega_z_dot = 0, of any size */
  double lever; /* m, s kappa */
  double brake; /* N m, capacity of the brake times kappa */
} AxleLaw;

/* (scene, kappa) => its law; a ground that pulls has no friction: the brake's part is left */
static inline AxleLaw axle_law_of(const WheelScene* scene, double kappa, int pulls) {
  AxleLaw law;
  law.held = scene->friction.kind == WHEEL_HELD;
  law.lever = pulls ? 0.0 : scene->wheel.s * kappa;
  law.brake = scene->load.brake * kappa;
  return law;
}

/* (law, N) => tau; not of a held wheel */
static inline double axle_moment_of(const AxleLaw* law, double N) { return -(law->lever * N + law->brake); }

#endif
