/* Quarter car: a sprung mass B above the wheel's centre O, linked to it by springs and dampers without mass.
 *
 * Fixed axes X, Y, Z, Z up; SI units. The links give force F at O and, through the hub carrier, the moments M_1
 * (camber) and M_2 (toe) along the wheel's carrier axes; the hub motor gives M_3 about the axle. B does not turn. */
#ifndef QUARTER_CAR_H
#define QUARTER_CAR_H

/* Value references, in the order of modelDescription.xml. */
enum {
  m_B,
  g,
  k_h,
  c_h,
  k_v,
  c_v,
  l_0,
  k_theta,
  c_theta,
  theta_0,
  k_psi,
  c_psi,
  psi_0,
  M_drive,
  t_drive,
  t_couple,
  X_B_start,
  Y_B_start,
  Z_B_start,
  X_O,
  Y_O,
  Z_O,
  X_O_dot,
  Y_O_dot,
  Z_O_dot,
  psi,
  theta,
  psi_dot,
  theta_dot,
  F_X,
  F_Y,
  F_Z,
  M_1,
  M_2,
  M_3,
  X_B,
  Y_B,
  Z_B,
  X_B_dot,
  Y_B_dot,
  Z_B_dot,
  variable_count,
  first_input = X_O,
  first_output = F_X,
  input_count = first_output - first_input
};

typedef struct QuarterCar {
  double stored[first_output];     /* parameters and inputs */
  double slope[input_count];       /* first derivatives of the inputs, for one communication step */
  double t;                        /* s */
  double position[3], velocity[3]; /* of B */
} QuarterCar;

void quarter_car_reset(QuarterCar* car);
void quarter_car_start(QuarterCar* car);
/* From t to t + h with the inputs running straight along their slopes; the slopes are used up. */
void quarter_car_step(QuarterCar* car, double h);
/* Value and time derivative of a variable now. */
double quarter_car_value(const QuarterCar* car, unsigned variable);
double quarter_car_rate(const QuarterCar* car, unsigned variable);

#endif
