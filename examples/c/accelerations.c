/* Accelerations and forces of the paper's wheel at one instant, without FMI: with friction, under a drive torque, and
 * held at omega_z = 0. docs/c_header.md: how to compile it. Fixed axes X, Y, Z with Z up; SI units. */
#include <stdio.h>
#include "wheel_equations.h"

static void print(const char* name, const WheelScene* scene, const double* y) {
  WheelDynamics now;
  wheel_reduced.dynamics(scene, y, &now);
  printf("%-9s theta_ddot = %8.4f rad/s2, omega_z_dot = %8.4f rad/s2, N = %8.4f N, tau = %7.4f N m\n", name,
         now.theta_ddot, now.omega_z_dot, now.lambda[2], now.tau + 0.0); /* no -0 */
}

int main(void) {
  WheelParameters wheel = {.m = 20, .r_0 = 0.3, .r = 0.05, .J_x = 0.9, .J_y = 0.9, .J_z = 1.8, .g_n = 9.81, .s = 0.03};
  WheelMotion motion = {.psi = 1.570796, .theta = 1.308997, .phi_dot = -2};
  WheelLoad drive = {.M = {0, 0, -5}};
  double y[WHEEL_SLIDING_STATES];
  wheel_reduced.start(&wheel, &motion, y);

  WheelScene free_wheel = wheel_scene(&wheel, NULL, (WheelFriction){.kind = WHEEL_FRICTIONLESS});
  WheelScene rolling = wheel_scene(&wheel, NULL, (WheelFriction){.kind = WHEEL_ROLLING, .sigma = -1});
  WheelScene driven = wheel_scene(&wheel, &drive, rolling.friction);
  print("free", &free_wheel, y);
  print("rolling", &rolling, y);
  print("driven", &driven, y);

  y[WHEEL_OMEGA_3] = 0; /* omega_z = 0: what moment would hold it there? */
  WheelScene held = wheel_scene(&wheel, &drive, (WheelFriction){.kind = WHEEL_HELD});
  print("held", &held, y);
  return 0;
}
