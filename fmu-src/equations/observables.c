/* Quantities read off a motion, whatever formulation computed it: energy, contact point, force of the ground in wheel
 * axes, required friction coefficient. Fixed axes unless said. */
#include <math.h>

#include "frame.h"

double wheel_height(const WheelParameters* wheel, double theta) { return wheel->r_0 * sin(theta) + wheel->r; }

double wheel_energy(const WheelParameters* wheel, const WheelKinematics* k) {
  double s = sin(k->theta), sin_phi = sin(k->phi), cos_phi = cos(k->phi);
  /* omega = [Q]{beta_dot}, (8), body axes */
  double omega_x = k->psi_dot * s * sin_phi + k->theta_dot * cos_phi;
  double omega_y = k->psi_dot * s * cos_phi - k->theta_dot * sin_phi;
  double v_squared = k->X_O_dot * k->X_O_dot + k->Y_O_dot * k->Y_O_dot + k->Z_O_dot * k->Z_O_dot;
  double rotation =
      wheel->J_x * omega_x * omega_x + wheel->J_y * omega_y * omega_y + wheel->J_z * k->omega_z * k->omega_z;
  return 0.5 * (wheel->m * v_squared + rotation) +
         wheel->m * (wheel->g_n * k->Z_O - wheel->g_X * k->X_O - wheel->g_Y * k->Y_O);
}

/* The contact lies r_0 cos(theta) to the right of O: across e1, on the side of (sin(psi), -cos(psi)). */
WheelContact wheel_contact(const WheelParameters* wheel, const WheelKinematics* k) {
  double sin_psi = sin(k->psi), cos_psi = cos(k->psi);
  double right = wheel->r_0 * cos(k->theta), right_dot = -wheel->r_0 * sin(k->theta) * k->theta_dot;
  return (WheelContact){
      .X_C = k->X_O + right * sin_psi,
      .Y_C = k->Y_O - right * cos_psi,
      .X_C_dot = k->X_O_dot + right_dot * sin_psi + right * k->psi_dot * cos_psi,
      .Y_C_dot = k->Y_O_dot - right_dot * cos_psi + right * k->psi_dot * sin_psi,
  };
}

void wheel_horizontal_force(const WheelKinematics* k, const double lambda[3], double force[2]) {
  double sin_psi = sin(k->psi), cos_psi = cos(k->psi);
  force[0] = lambda[0] * cos_psi + lambda[1] * sin_psi;
  force[1] = lambda[1] * cos_psi - lambda[0] * sin_psi;
}

double wheel_required_friction(const double lambda[3]) {
  if (lambda[2] <= 0) return INFINITY;
  return sqrt(lambda[0] * lambda[0] + lambda[1] * lambda[1]) / lambda[2];
}

double wheel_required_friction_rate(const double lambda[3], const double lambda_dot[3]) {
  double mu = wheel_required_friction(lambda), N = lambda[2];
  if (mu == 0) return 0;
  return (lambda[0] * lambda_dot[0] + lambda[1] * lambda_dot[1]) / (mu * N) / N - mu * lambda_dot[2] / N;
}

double wheel_axle_capacity(double s, double N, double brake) { return s * (N < 0 ? 0 : N) + brake; }

/* Without any capacity there is no tau. */
static double brake_part(const WheelAxleMoment* now, double* capacity) {
  *capacity = wheel_axle_capacity(now->s, now->N, now->brake);
  return *capacity > 0 ? now->brake / *capacity : 1;
}

double wheel_brake_moment(const WheelAxleMoment* now) {
  double capacity, part = brake_part(now, &capacity);
  return now->tau * part;
}

double wheel_brake_moment_rate(const WheelAxleMoment* now, const WheelAxleMoment* rate) {
  double capacity, part = brake_part(now, &capacity);
  double rolling_rate = now->N > 0 ? rate->s * now->N + now->s * rate->N : 0;
  if (!(capacity > 0)) { /* of what comes to act, the brake's share */
    double capacity_rate = rate->brake + rolling_rate;
    return capacity_rate != 0 ? rate->tau * rate->brake / capacity_rate : 0;
  }
  double part_rate = (rate->brake * (1 - part) - part * rolling_rate) / capacity;
  return rate->tau * part + now->tau * part_rate;
}

/* Euler's first two equations, dH/dt = M + c x lambda + M_guide. */
void wheel_guide_moment(const WheelScene* scene, const WheelKinematics* k, const WheelDynamics* d, double out[2]) {
  const WheelParameters* w = &scene->wheel;
  const double y[] = {k->theta, k->theta_dot, k->psi_dot * sin(k->theta), k->omega_z, k->psi, k->phi};
  Frame f = frame_of(w, y);
  Inertia I = inertia_of(w, k->phi);
  Moment M = moment_of(scene, &I, &f);
  double omega_2_dot = guided_rate(&f, d->psi_ddot), force[2];
  wheel_horizontal_force(k, d->lambda, force);
  out[0] = I.I_11 * d->theta_ddot + I.p * omega_2_dot - M.M_1 + w->r_0 * f.cos_theta * d->lambda[2] -
           wheel_height(w, k->theta) * force[1];
  out[1] = I.p * d->theta_ddot + I.I_22 * omega_2_dot - M.M_2 + f.eta * force[0];
}
