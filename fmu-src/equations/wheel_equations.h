/* The wheel's equations behind one C header: "Dynamics of an automobile wheel" (Stanescu & Mihalcea).
 *
 * A torus-shaped wheel rolls without slip on the plane Z = 0, with or without rolling resistance, or slides on it under
 * Coulomb's friction. Two formulations compute the same motion for any principal moments of inertia:
 *   reduced    Newton and Euler with the constraints solved in advance: they hold exactly; 8 states
 *   multibody  the paper's system (24), a matrix of 9 x 9 solved at each state, which is that of `reduced`
 * While the wheel slides, two constraints are released; the slip joins the state of `sliding` and `multibody_sliding`.
 * In each the wheel may be on a wheel carrier, which directs the axle (WheelScene.guided).
 * All functions are pure: no time, no allocation, no global state. SI units, angles in rad.
 *
 * Frames (docs/variables.md): fixed axes X, Y, Z with Z up; z-x-z Euler angles psi, theta, phi; the non-spinning frame
 * e1 (along the line of nodes, the rolling direction), e2 (in the wheel plane, upwards), e3 (the axle); body axes x, y,
 * z = e3 spin with the wheel. Domain: 0 < theta < pi; mass, r_0 and moments positive, r >= 0. */
#ifndef WHEEL_EQUATIONS_H
#define WHEEL_EQUATIONS_H

#ifdef __cplusplus
extern "C" {
#endif

enum { WHEEL_REDUCED_STATES = 8, WHEEL_SLIDING_STATES = 10 };

/* Places in the state of `wheel_reduced`, angular velocity along e1, e2, e3; and in that of `wheel_sliding`
 * behind them the slip |u| and its direction chi. */
enum { WHEEL_THETA, WHEEL_OMEGA_1, WHEEL_OMEGA_2, WHEEL_OMEGA_3, WHEEL_PSI, WHEEL_PHI, WHEEL_X_O, WHEEL_Y_O };
enum { WHEEL_SLIP = WHEEL_REDUCED_STATES, WHEEL_CHI };

/* Constants of one wheel, (1), (2), (27)-(31). */
typedef struct WheelParameters {
  double m;             /* kg, > 0 */
  double r_0, r;        /* m; radius of the ring of tube centres > 0, radius of the tube >= 0 */
  double J_x, J_y, J_z; /* kg m2, principal central moments, z is the axle */
  double g_n;           /* m/s2, >= 0, gravity across the road, normal to it: against Z */
  double s;             /* m, >= 0; rolling resistance: its moment is at most s N */
  double g_X, g_Y;      /* m/s2, gravity along the road: zero where it is level */
} WheelParameters;

/* Puts the wheel on a road that rises by `slope` (rad, 0 <= slope < pi/2) towards `direction` (rad in the X-Y plane,
 * from X to Y). The axes stay the road's, Z across it, and the weight tilts: g (the whole of gravity, m/s2) is
 * distributed to the wheel's g_n, g_X, g_Y. */
void wheel_set_slope(WheelParameters* wheel, double g, double slope, double direction);

/* What acts on the wheel besides weight and ground: the external column {F} of (15), and a brake. */
typedef struct WheelLoad {
  double F[3];     /* N at O, fixed axes X, Y, Z */
  double M[3];     /* N m on the wheel along e1, e2, e3: M[2]: about the axle, whichever way the wheel turns */
  double brake;    /* N m, >= 0: largest moment of a dry brake about the axle, which acts against omega_z */
  double guide[2]; /* rad/s2, psi_ddot and theta_ddot, which the wheel carrier gives a guided wheel */
} WheelLoad;

/* The law of rolling resistance, which a brake shares: the moment tau of ground and brake about the axle is
 * tau = -(s N + brake) kappa. N is the normal force lambda_3; a ground that pulls (N <= 0) has no friction, and the
 * brake's part alone is left (WheelGround). */
typedef enum WheelFrictionKind {
  WHEEL_NO_LAW,       /* the law of a struct filled with zeros: every acceleration and force is NaN */
  WHEEL_FRICTIONLESS, /* kappa = 0: no moment, whatever s and the brake are */
  WHEEL_ROLLING,      /* kappa = sigma, (22) with sigma = sign(omega_z) kept */
  WHEEL_HELD,         /* the tau that keeps omega_z_dot = 0 (Filippov's sliding mode at omega_z = 0), of any size */
  WHEEL_REGULARIZED   /* kappa = tanh(omega_z / omega_s) */
} WheelFrictionKind;

typedef struct WheelFriction {
  WheelFrictionKind kind;
  double sigma;   /* for WHEEL_ROLLING: +1 or -1, which `wheel_scene` checks; the equations take any kappa */
  double omega_s; /* rad/s, > 0, for WHEEL_REGULARIZED */
} WheelFriction;

/* kappa of a law; NaN without one. The moment on a held wheel follows from omega_z_dot = 0. */
double wheel_kappa(const WheelFriction* friction, double omega_z);

/* Where the ground has friction. A solver that finds the instants at which N = 0 keeps one branch between two of them,
 * so that no trial step meets the corner of the law. */
typedef enum WheelGround {
  WHEEL_GROUND_BY_FORCE, /* where N > 0 */
  WHEEL_GROUND_PRESSES,  /* s N whatever the sign of N */
  WHEEL_GROUND_PULLS     /* nowhere */
} WheelGround;

/* Whether the material point at the contact rests on the ground, or slides over it. */
typedef enum WheelContactMode { WHEEL_GRIPS, WHEEL_SLIDES } WheelContactMode;

/* All that a right-hand side needs besides the state. `wheel_scene` makes one and checks it; it rolls. One that slides
 * belongs to the formulations with a slip, and others ignore its mu_slide. */
typedef struct WheelScene {
  WheelParameters wheel;
  WheelFriction friction;
  WheelLoad load;
  WheelGround ground;
  WheelContactMode contact;
  double mu_slide; /* >= 0, coefficient of sliding friction: the ground's horizontal force is mu_slide N */
  /* Not 0: on a wheel carrier psi_dot and theta_dot are given: their rates are `load.guide`, whatever acts: the limit
   * of infinite moments of inertia across the axle, with any J_x and J_y. `wheel_guide_moment` is the carrier's. */
  int guided;
} WheelScene;

/* The scene of a wheel under a load (NULL: none) and a law of rolling resistance, for example
 *   wheel_scene(&wheel, NULL, (WheelFriction){.kind = WHEEL_ROLLING, .sigma = -1}).
 * The scene has WHEEL_NO_LAW, so that every result is NaN instead of a motion that was not meant, where s or the brake
 * is negative, where WHEEL_ROLLING has another sigma than +1 or -1, or where omega_s of WHEEL_REGULARIZED is not
 * positive. */
WheelScene wheel_scene(const WheelParameters* wheel, const WheelLoad* load, WheelFriction friction);

/* Position and velocity that may be chosen freely, (32), (33); the rest follows from the constraints. */
typedef struct WheelMotion {
  double psi, theta, phi;             /* rad */
  double psi_dot, theta_dot, phi_dot; /* rad/s */
  double X_O, Y_O;                    /* m */
  double slip_x, slip_y;              /* m/s, of the material point at the contact */
} WheelMotion;

/* Positions and velocities, fixed axes. */
typedef struct WheelKinematics {
  double X_O, Y_O, Z_O;               /* m */
  double psi, theta, phi;             /* rad, not wrapped */
  double X_O_dot, Y_O_dot, Z_O_dot;   /* m/s */
  double psi_dot, theta_dot, phi_dot; /* rad/s */
  double omega_z;                     /* rad/s, (21) */
} WheelKinematics;

/* Accelerations and reactions, fixed axes. */
typedef struct WheelDynamics {
  double X_O_ddot, Y_O_ddot, Z_O_ddot;   /* m/s2 */
  double psi_ddot, theta_ddot, phi_ddot; /* rad/s2 */
  double omega_z_dot;                    /* rad/s2 */
  double lambda[3];                      /* N, force of the ground on the wheel, (26) */
  double tau;                            /* N m, moment of ground and brake about the axle */
} WheelDynamics;

/* A slip in the direction chi, at a state of `wheel_reduced`, under the scene's laws and whatever its `contact` is. Let
 * d be the unit vector along the slip, and t a quarter turn ahead of it. The rate of the slip, without the turning of
 * e1, is growth d + turn t. It does not depend on |u|. So |u| chi_dot = turn - |u| psi_dot, and near |u| = 0 chi
 * settles where turn falls through zero. */
typedef struct WheelSlip {
  double N;            /* N, normal force */
  double room;         /* 1 without sliding friction; where it falls to zero, the wheel jams: no N >= 0 exists */
  double growth, turn; /* m/s2 */
  double settling;     /* m/s2, -d(turn)/d(chi) */
} WheelSlip;

/* Below this WheelSlip.room the wheel jams: no normal force satisfies the equations. */
#define WHEEL_LEAST_ROOM 1e-5

/* One formulation: how its state vector y is started, moved and read. */
typedef struct WheelFormulation {
  int states;
  /* y (out, `states` entries) from the free initial values. */
  void (*start)(const WheelParameters* wheel, const WheelMotion* motion, double* y);
  /* y_dot = f(y), and the normal force N that goes with it; non-finite or meaningless outside 0 < theta < pi. */
  double (*derivative)(const WheelScene* scene, const double* y, double* y_dot);
  void (*kinematics)(const WheelParameters* wheel, const double* y, WheelKinematics* out);
  void (*dynamics)(const WheelScene* scene, const double* y, WheelDynamics* out);
} WheelFormulation;

/* y by WHEEL_THETA and on. Where J_x = J_y, phi enters nothing, and a simpler elimination is taken. X_O and Y_O never
 * enter, psi does only where F_X or F_Y is not zero. */
extern const WheelFormulation wheel_reduced;

/* The state of `wheel_reduced`; its rates, accelerations and reactions by (24), from the q and q_dot of (25) that
 * satisfy (19) and (32) there. */
extern const WheelFormulation wheel_multibody;

/* y = that of `wheel_reduced`, |u| and chi, by WHEEL_THETA and on: Newton and Euler, with the ground's horizontal force
 * -mu_slide N u / |u| given and the vertical constraint alone solved in advance. u = |u| (cos(chi), sin(chi)) is the
 * slip, the velocity of the wheel's material point at the contact, along e1 and across it to the left. At |u| = 0 the
 * rate of chi is written as zero: it is any, or infinite. */
extern const WheelFormulation wheel_sliding;

/* The state of `wheel_sliding`: (24) with Coulomb's law in the place of the two horizontal constraints. */
extern const WheelFormulation wheel_multibody_sliding;

/* The states of model exchange, x: X_O, Y_O, psi, theta, phi, theta_dot, psi_dot, omega_z. The motion that the
 * state y of `wheel_reduced` describes, in the paper's variables. */
enum {
  WHEEL_EULER_X_O,
  WHEEL_EULER_Y_O,
  WHEEL_EULER_PSI,
  WHEEL_EULER_THETA,
  WHEEL_EULER_PHI,
  WHEEL_EULER_THETA_DOT,
  WHEEL_EULER_PSI_DOT,
  WHEEL_EULER_OMEGA_Z,
  WHEEL_EULER_STATES
};
/* (y, and psi_dot, whose last bit y has not) => x. */
void wheel_euler_states(const double* y, double psi_dot, double* x);
/* x => y. */
void wheel_reduced_state(const double* x, double* y);
/* (x, and y_dot there) => x_dot. */
void wheel_euler_rates(const double* x, const double* y_dot, double* x_dot);
/* What is a state in x is read from it to the bit. */
void wheel_euler_kinematics(const WheelParameters* wheel, const double* x, WheelKinematics* out);

WheelSlip wheel_slip(const WheelScene* scene, const double* reduced, double chi);

/* The direction chi in which a slip from |u| = 0 begins: it grows and its direction is kept
 * (turn = 0, settling > 0). Of several that nearest, to two degrees, to the direction against the force that rolling
 * would need. NaN where there is none: the ground does not press, or the wheel jams. */
double wheel_slip_direction(const WheelScene* scene, const double* reduced);

/* Total energy, J: translation, rotation, height of O against gravity, zero at the origin. */
double wheel_energy(const WheelParameters* wheel, const WheelKinematics* motion);

/* Ratio of tangential to normal force of the ground: the friction coefficient that rolling without slip needs.
 * Infinite where the ground does not press (lambda_3 <= 0). */
double wheel_required_friction(const double lambda[3]);
/* Its rate of change from that of the force; the mean of both sides, 0, where no force is tangential. NaN where it is
 * infinite. */
double wheel_required_friction_rate(const double lambda[3], const double lambda_dot[3]);

/* N m, the largest moment of ground and brake about the axle: s N + brake. A ground that pulls has no friction. */
double wheel_axle_capacity(double s, double N, double brake);

/* What acts about the axle, or its rate by some quantity. */
typedef struct WheelAxleMoment {
  double tau;   /* N m, moment of ground and brake */
  double N;     /* N, normal force */
  double s;     /* m */
  double brake; /* N m, capacity of the brake */
} WheelAxleMoment;

/* The brake's part of tau, N m: brake and rolling resistance share it in proportion to their capacities, brake and s N.
 * So it is -brake kappa while the wheel rolls, and has no corner where the wheel is released or held. */
double wheel_brake_moment(const WheelAxleMoment* now);

/* Its rate by some quantity. */
double wheel_brake_moment_rate(const WheelAxleMoment* now, const WheelAxleMoment* rate);

/* The point of the ground that the wheel touches, and how fast it moves along the ground (not the wheel's material
 * point there, which rests). Fixed axes, m, m/s. */
typedef struct WheelContact {
  double X_C, Y_C, X_C_dot, Y_C_dot;
} WheelContact;
WheelContact wheel_contact(const WheelParameters* wheel, const WheelKinematics* motion);

/* The ground's horizontal force in wheel axes, N: force[0] along e1 (lambda_x), force[1] across it, to the left of
 * somebody who looks along e1 (lambda_y). */
void wheel_horizontal_force(const WheelKinematics* motion, const double lambda[3], double force[2]);

/* The moment of the wheel carrier on a guided wheel, N m, along e1 and e2 (out). */
void wheel_guide_moment(const WheelScene* scene, const WheelKinematics* motion, const WheelDynamics* dynamics,
                        double out[2]);

/* The motion of a guided wheel after a jump of the carrier's rates to psi_dot and theta_dot, rad/s: the limit of ever
 * steeper ramps of both. phi_dot and a slip change with them; a wheel that rolls goes on rolling. hold: of a held wheel
 * (WHEEL_HELD), or of one in the layer of a regularized law, the moment about the axle that could be added before it is
 * released, N m. */
void wheel_jump(const WheelScene* scene, double hold, double psi_dot, double theta_dot, WheelMotion* motion);

/* The same angle, rad, less whole turns: from -pi to pi: exact to the last digit up to 1e12 rad. */
double wheel_less_turns(double angle);

/* The angle from the first axis to (x, y), rad, from -pi to pi; 0 for (0, 0). */
double wheel_angle_of(double x, double y);

/* Height of O, m: r_0 sin(theta) + r, (32). */
double wheel_height(const WheelParameters* wheel, double theta);

#ifdef __cplusplus
}
#endif
#endif
