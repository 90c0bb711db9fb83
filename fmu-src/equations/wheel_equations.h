/* The wheel's equations behind one C header: "Dynamics of an automobile wheel" (Stanescu & Mihalcea).
 *
 * A torus-shaped wheel rolls without slip on the plane Z = 0, with or without rolling friction. Two formulations
 * compute the same motion:
 *   reduced    J_x = J_y; (theta, omega_1, omega_2, omega_3) closed, the rest quadratures: constraints hold exactly
 *   multibody  the paper's system (24), any J; unknowns q and q_dot, constraints held at acceleration level
 * All functions are pure: no time, no allocation, no global state. SI units, angles in rad.
 *
 * Frames (docs/notation.md): fixed axes X, Y, Z with Z up; z-x-z Euler angles psi, theta, phi; the carrier e1 (along
 * the line of nodes, the rolling direction), e2 (in the wheel plane, up the slope), e3 (the axle) does not spin with
 * the wheel; body axes x, y, z = e3 do. Domain: 0 < theta < pi, masses, radii and moments positive. */
#ifndef WHEEL_EQUATIONS_H
#define WHEEL_EQUATIONS_H

#ifdef __cplusplus
extern "C" {
#endif

enum { WHEEL_REDUCED_STATES = 8, WHEEL_MULTIBODY_STATES = 12, WHEEL_MAX_STATES = 12 };

/* Constants of one wheel, (1), (2), (27)-(31). */
typedef struct WheelParameters {
  double m;             /* kg, > 0 */
  double r_0, r;        /* m; radius of the ring of tube centres > 0, radius of the tube >= 0 */
  double J_x, J_y, J_z; /* kg m2, principal central moments, z is the axle */
  double g;             /* m/s2, >= 0 */
  double s;             /* m, coefficient of rolling friction, >= 0 */
} WheelParameters;

/* The external column {F} of (15) besides the weight. */
typedef struct WheelLoad {
  double F[3]; /* N at O, fixed axes X, Y, Z */
  double M[3]; /* N m on the wheel, carrier axes e1, e2, e3: M[2] drives or brakes about the axle */
} WheelLoad;

/* What the ground does about the axle. N is the normal force lambda_3; a ground that pulls (N < 0) has no friction. */
typedef enum WheelFrictionKind {
  WHEEL_FRICTIONLESS, /* moment 0 */
  WHEEL_ROLLING,      /* moment -s N sigma, (22) with sigma = sign(omega_z) held fixed */
  WHEEL_HELD,         /* the moment tau that keeps omega_z_dot = 0 (Filippov's sliding mode at omega_z = 0) */
  WHEEL_REGULARIZED   /* moment -s N tanh(omega_z / omega_s) */
} WheelFrictionKind;

typedef struct WheelFriction {
  WheelFrictionKind kind;
  double sigma;   /* +1 or -1, for WHEEL_ROLLING */
  double omega_s; /* rad/s, > 0, for WHEEL_REGULARIZED */
} WheelFriction;

/* All that a right-hand side needs besides the state. */
typedef struct WheelScene {
  WheelParameters wheel;
  WheelFriction friction;
  WheelLoad load;
  int loaded; /* 0: the load is zero and no term of it is evaluated */
} WheelScene;

/* Position and velocity that may be chosen freely, (32), (33); the rest follows from the constraints. */
typedef struct WheelMotion {
  double psi, theta, phi;             /* rad */
  double psi_dot, theta_dot, phi_dot; /* rad/s */
  double X_O, Y_O;                    /* m */
} WheelMotion;

/* Positions and velocities, fixed axes. */
typedef struct WheelKinematics {
  double X_O, Y_O, Z_O;               /* m */
  double psi, theta, phi;             /* rad, not wrapped */
  double X_O_dot, Y_O_dot, Z_O_dot;   /* m/s */
  double psi_dot, theta_dot, phi_dot; /* rad/s */
  double omega_z;                     /* rad/s, (21) */
} WheelKinematics;

/* Accelerations and the ground's answer, fixed axes. */
typedef struct WheelDynamics {
  double X_O_ddot, Y_O_ddot, Z_O_ddot;   /* m/s2 */
  double psi_ddot, theta_ddot, phi_ddot; /* rad/s2 */
  double omega_z_dot;                    /* rad/s2 */
  double lambda[3];                      /* N, force of the ground on the wheel, (26) */
  double tau;                            /* N m, moment of the ground about the axle */
} WheelDynamics;

/* One formulation: how its state vector y is started, moved and read. */
typedef struct WheelFormulation {
  const char* name;
  int states;
  /* y (out, `states` entries) from the free initial values. */
  void (*start)(const WheelParameters* wheel, const WheelMotion* motion, double* y);
  /* y_dot = f(y), and the normal force N that goes with it; non-finite or meaningless outside 0 < theta < pi. */
  double (*derivative)(const WheelScene* scene, const double* y, double* y_dot);
  /* Where y holds omega_z, (21), and theta. */
  int spin_index, tilt_index;
  void (*kinematics)(const WheelParameters* wheel, const double* y, WheelKinematics* out);
  /* The same without X_O_dot and Y_O_dot, which cost the sine and cosine of psi. */
  void (*pose)(const WheelParameters* wheel, const double* y, WheelKinematics* out);
  void (*dynamics)(const WheelScene* scene, const double* y, WheelDynamics* out);
  /* d lambda/dt along the motion, N/s; load_dot is the rate of the load (NULL: constant). */
  void (*reaction_rates)(const WheelScene* scene, const WheelLoad* load_dot, const double* y, double lambda_dot[3]);
  /* J (states x states, column by column): J[i + states * j] = d f_i / d y_j, exact. */
  void (*jacobian)(const WheelScene* scene, const double* y, double* J);
  /* Sets omega_z to exactly zero: the start of a phase in which it is held there. */
  void (*stop_spin)(const WheelParameters* wheel, double* y);
  /* The first closed_states rates know the first closed_states states alone; the rest are quadratures.
   * closed_derivative gives these rates only: it spares the sine and cosine of psi where nothing else needs them. */
  int closed_states;
  double (*closed_derivative)(const WheelScene* scene, const double* y, double* y_dot);
} WheelFormulation;

/* y = theta, omega_1, omega_2, omega_3 (carrier), psi, phi, X_O, Y_O. Needs J_x = J_y (J_x is used). */
extern const WheelFormulation wheel_reduced;

/* y = q, q_dot with q = X_O, Y_O, Z_O, psi, theta, phi, (25), but with omega_z, (21), in the place of phi_dot: a wheel
 * whose spin is held keeps it at exactly zero. The constraints are stabilised: what rounding and step errors leave of
 * [B]{q_dot} and of Z_O - height decays, on the true motion nothing changes. */
extern const WheelFormulation wheel_multibody;

/* Total energy, J: translation, rotation, height of O above the ground. */
double wheel_energy(const WheelParameters* wheel, const WheelKinematics* motion);

/* Tangential over normal force of the ground: the friction coefficient that rolling without slip needs.
 * Infinite where the ground does not press (lambda_3 <= 0). */
double wheel_required_friction(const double lambda[3]);

/* Height of O, m: r_0 sin(theta) + r, (32). */
double wheel_height(const WheelParameters* wheel, double theta);

/* Largest entry of |[B]{q_dot}|, m/s, (19), and |Z_O - height|, m: how far a state is off the constraints. */
void wheel_constraint_residuals(const WheelParameters* wheel, const WheelKinematics* motion, double* velocity,
                                double* height);

#ifdef __cplusplus
}
#endif
#endif
