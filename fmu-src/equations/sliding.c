/* The wheel that slides, reduced form: Newton and Euler about O for any principal moments of inertia; the ground's
 * horizontal force is mu_slide N against the slip, and only the height of O is a constraint. Carrier frame e1, e2, e3;
 * x along e1, y horizontal to the left of it. docs/equations.md derives every line. */
#include <string.h>

#include "carrier.h"

/* One state under a load, before sliding friction is known. */
typedef struct Body {
  Carrier carrier;
  Inertia inertia;
  double d_x, d_y; /* direction of the slip */
  double h, l;     /* m, height of O, r_0 sin(theta) + r, and its rate per unit of omega_1, r_0 cos(theta) */
  double F_x, F_y; /* N, external force on O, weight included */
  double N_rest;   /* N, normal force for omega_1_dot = 0 */
  Moment M;        /* N m, external less gyroscopic moment */
  double a_x, a_y; /* m/s2, rate of the slip without forces and without omega_dot */
  int held;        /* omega_3 is held at zero */
  double mu, s;    /* 1 and m, coefficients of the ground's friction; zero where it pulls */
  double kappa;    /* tau = -(s N + brake) kappa */
  double brake;    /* N m */
} Body;

/* What follows. */
typedef struct Answer {
  double room; /* above zero as long as friction does not wedge the wheel */
  double N, tau;
  double omega_1_dot, omega_2_dot, omega_3_dot;
  double f_x, f_y; /* N, horizontal force of the ground */
  double u_x, u_y; /* m/s2, rate of the slip without the turning of the axes */
} Answer;

/* N = N_free + g f and rate of the slip = w + A f for a horizontal force f of the ground; tau follows N where the wheel
 * is not held. */
typedef struct Response {
  double mu, N_free, w_x, w_y;
  double g_x, g_y, A_xx, A_xy, A_yx, A_yy;
} Response;

__attribute__((always_inline)) static inline Body body_of(const WheelScene* scene, const double* y, double chi) {
  const WheelParameters* w = &scene->wheel;
  const WheelLoad* load = &scene->load;
  Body b = {.carrier = carrier_of(w, y), .inertia = inertia_of(w, y[PHI]), .d_x = cos(chi), .d_y = sin(chi)};
  const Carrier* c = &b.carrier;
  double F_X = load->F[0] + w->m * w->g_X, F_Y = load->F[1] + w->m * w->g_Y;
  double omega_1_2 = c->omega_1 * c->omega_1;
  b.h = w->r_0 * c->sin_theta + w->r;
  b.l = w->r_0 * c->cos_theta;
  if (F_X != 0 || F_Y != 0) {
    b.F_x = F_X * c->cos_psi + F_Y * c->sin_psi;
    b.F_y = F_Y * c->cos_psi - F_X * c->sin_psi;
  }
  b.N_rest = w->m * (w->g - w->r_0 * c->sin_theta * omega_1_2) - load->F[2];
  b.M = gyroscopic_moment(w, &b.inertia, c);
  b.M.M_1 += load->M[0];
  b.M.M_2 += load->M[1];
  b.M.M_3 += load->M[2];
  b.a_x = c->omega_1 * (w->r * c->sin_theta * c->omega_2 + c->eta * c->omega_3) - c->psi_dot * b.h * c->omega_1;
  b.a_y = b.l * omega_1_2 - c->psi_dot * c->v_1;
  b.held = scene->friction.kind == WHEEL_HELD;
  b.mu = scene->ground == WHEEL_GROUND_PULLS ? 0 : scene->mu_slide;
  b.s = scene->ground == WHEEL_GROUND_PULLS ? 0 : w->s;
  b.kappa = wheel_kappa(&scene->friction, c->omega_3);
  b.brake = load->brake;
  return b;
}

/* The equations of motion for a force of the ground -mu N (cos, sin):
 *   [ I_11 + m l (l + mu h sin)   p    ]                [ M_1 - (l + mu h sin) N_rest ]
 *   [ p - mu m l eta cos          I_22 ] {omega_dot} =  [ M_2 + mu eta cos N_rest     ]
 *   J_z omega_3_dot = M_3 + rho f_x + tau,    N = N_rest + m l omega_1_dot */
static inline Answer answer_of(const WheelParameters* w, const Body* b) {
  const Carrier* c = &b->carrier;
  const Inertia* I = &b->inertia;
  double arm = b->l + b->mu * b->h * b->d_y, along = b->mu * c->eta * b->d_x;
  double a_11 = I->I_11 + w->m * b->l * arm, a_12 = I->p;
  double a_21 = I->p - w->m * b->l * along, a_22 = I->I_22;
  double b_1 = b->M.M_1 - arm * b->N_rest, b_2 = b->M.M_2 + along * b->N_rest;
  double determinant = a_11 * a_22 - a_12 * a_21;
  double inverse = 1 / determinant, per_mass = 1 / w->m;
  Answer a = {.room = determinant}; /* for mu = 0 it is positive */
  a.omega_1_dot = (a_22 * b_1 - a_12 * b_2) * inverse;
  a.omega_2_dot = (a_11 * b_2 - a_21 * b_1) * inverse;
  a.N = b->N_rest + w->m * b->l * a.omega_1_dot;
  a.f_x = -b->mu * a.N * b->d_x;
  a.f_y = -b->mu * a.N * b->d_y;
  double M_3 = b->M.M_3 + c->rho * a.f_x;
  a.tau = b->held ? -M_3 : -(b->s * a.N + b->brake) * b->kappa;
  a.omega_3_dot = b->held ? 0 : (M_3 + a.tau) / w->J_z;
  a.u_x = b->a_x + (b->F_x + a.f_x) * per_mass - c->eta * a.omega_2_dot + c->rho * a.omega_3_dot;
  a.u_y = b->a_y + (b->F_y + a.f_y) * per_mass + b->h * a.omega_1_dot;
  return a;
}

/* The same after the law of a ground that pulls (N <= 0) is taken into the body. The sign of
 * N is that without sliding friction as long as there is room. */
static inline Answer respond(const WheelScene* scene, Body* b) {
  Answer a = answer_of(&scene->wheel, b);
  if (a.N * a.room > 0 || scene->ground != WHEEL_GROUND_BY_FORCE) return a;
  b->mu = b->s = 0;
  return answer_of(&scene->wheel, b);
}

static Response response_of(const WheelScene* scene, const double* y) {
  const WheelParameters* w = &scene->wheel;
  Body b = body_of(scene, y, 0);
  const Inertia* I = &b.inertia;
  double mu = b.mu;
  b.mu = 0;
  Answer free = respond(scene, &b);
  double eta = b.carrier.eta, k = eta * I->p / I->I_22;
  double tilting = I->I_11 - I->p * I->p / I->I_22 + w->m * b.l * b.l;
  Response r = {
      .mu = free.N > 0 || scene->ground != WHEEL_GROUND_BY_FORCE ? mu : 0,
      .N_free = free.N,
      .w_x = free.u_x,
      .w_y = free.u_y,
      .g_x = w->m * b.l * k / tilting,
      .g_y = w->m * b.l * b.h / tilting,
      .A_xx = 1 / w->m + eta * eta / I->I_22 + k * k / tilting,
      .A_xy = k * b.h / tilting,
      .A_yx = k * b.h / tilting,
      .A_yy = 1 / w->m + b.h * b.h / tilting,
  };
  if (b.held) return r;
  double lever = b.carrier.rho / w->J_z;
  r.A_xx += lever * (b.carrier.rho - b.s * b.kappa * r.g_x);
  r.A_xy -= lever * b.s * b.kappa * r.g_y;
  return r;
}

static WheelSlip slip_of(const Response* r, double chi) {
  double d_x = cos(chi), d_y = sin(chi), room = 1 + r->mu * (r->g_x * d_x + r->g_y * d_y), N = r->N_free / room;
  double Ad_x = r->A_xx * d_x + r->A_xy * d_y, Ad_y = r->A_yx * d_x + r->A_yy * d_y;
  double At_x = r->A_xy * d_x - r->A_xx * d_y, At_y = r->A_yy * d_x - r->A_yx * d_y;
  double N_turn = r->mu * N * (r->g_x * d_y - r->g_y * d_x) / room; /* dN/d(chi) */
  double u_x = r->w_x - r->mu * N * Ad_x, u_y = r->w_y - r->mu * N * Ad_y;
  double turned_x = -r->mu * (N_turn * Ad_x + N * At_x), turned_y = -r->mu * (N_turn * Ad_y + N * At_y);
  double growth = u_x * d_x + u_y * d_y;
  return (WheelSlip){
      .N = N,
      .room = room,
      .growth = growth,
      .turn = u_y * d_x - u_x * d_y,
      .settling = growth - (turned_y * d_x - turned_x * d_y),
  };
}

WheelSlip wheel_slip(const WheelScene* scene, const double* reduced, double chi) {
  Response r = response_of(scene, reduced);
  return slip_of(&r, chi);
}

/* Without the pole where room = 0 it is a trigonometric polynomial of degree 2. */
static double turning(const Response* r, double chi) {
  WheelSlip slip = slip_of(r, chi);
  return slip.turn * slip.room;
}

static double zero_of_turning(const Response* r, double lo, double hi) {
  for (int i = 0; i < 60; ++i) {
    double middle = 0.5 * (lo + hi);
    if (turning(r, middle) > 0)
      lo = middle;
    else
      hi = middle;
  }
  return 0.5 * (lo + hi);
}

double wheel_slip_direction(const WheelScene* scene, const double* reduced) {
  enum { parts = 180 };
  const double part = 2 * 3.141592653589793 / parts, rounding = 1e-9;
  Response r = response_of(scene, reduced);
  /* A^-1 w, against the force of grip; its size does not matter */
  double against = wheel_angle_of(r.A_yy * r.w_x - r.A_xy * r.w_y, r.A_xx * r.w_y - r.A_yx * r.w_x);
  double found = NAN, least = -rounding * (fabs(r.w_x) + fabs(r.w_y));
  for (int i = 0; i < parts; ++i) { /* from `against` to both sides in turn */
    double lo = against + part * ((i % 2 ? -(i + 1) / 2 : i / 2) - 0.5), hi = lo + part;
    if (!(turning(&r, lo) > 0 && turning(&r, hi) <= 0)) continue;
    double chi = zero_of_turning(&r, lo, hi);
    WheelSlip slip = slip_of(&r, chi);
    int admissible = slip.growth >= least && slip.room > 0 && slip.N > 0 && slip.settling > 0;
    if (admissible && !(cos(chi - against) <= cos(found - against))) found = chi;
  }
  return found;
}

static void start(const WheelParameters* wheel, const WheelMotion* motion, double* y) {
  memset(y, 0, sizeof(double) * WHEEL_SLIDING_STATES);
  wheel_reduced.start(wheel, motion, y);
  y[SPEED] = sqrt(motion->slip_x * motion->slip_x + motion->slip_y * motion->slip_y);
  y[CHI] = wheel_angle_of(motion->slip_x, motion->slip_y);
}

/* The velocity of O: that of rolling, and the slip. */
static inline void set_velocity(const Body* b, double speed, double* X_dot, double* Y_dot) {
  const Carrier* c = &b->carrier;
  double along = c->v_1 + speed * b->d_x, left = speed * b->d_y - b->h * c->omega_1;
  *X_dot = along * c->cos_psi - left * c->sin_psi;
  *Y_dot = along * c->sin_psi + left * c->cos_psi;
}

/* N is infinite where friction wedges the wheel. */
static double derivative(const WheelScene* scene, const double* y, double* y_dot) {
  Body b = body_of(scene, y, y[CHI]);
  Answer a = respond(scene, &b);
  y_dot[THETA] = b.carrier.omega_1;
  y_dot[OMEGA_1] = a.omega_1_dot;
  y_dot[OMEGA_2] = a.omega_2_dot;
  y_dot[OMEGA_3] = a.omega_3_dot;
  y_dot[PSI] = b.carrier.psi_dot;
  y_dot[PHI] = b.carrier.phi_dot;
  set_velocity(&b, y[SPEED], &y_dot[X_O], &y_dot[Y_O]);
  y_dot[SPEED] = a.u_x * b.d_x + a.u_y * b.d_y;
  y_dot[CHI] = y[SPEED] == 0 ? 0 : (a.u_y * b.d_x - a.u_x * b.d_y) / y[SPEED] - b.carrier.psi_dot;
  y_dot[CHI + 1] = y_dot[CHI + 2] = 0;
  return a.room > 0 ? a.N : INFINITY;
}

static void pose(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  wheel_reduced.pose(wheel, y, out);
}

static void kinematics(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  Body b = {.carrier = carrier_of(wheel, y), .h = wheel_height(wheel, y[THETA])};
  b.d_x = cos(y[CHI]);
  b.d_y = sin(y[CHI]);
  wheel_reduced.pose(wheel, y, out);
  set_velocity(&b, y[SPEED], &out->X_O_dot, &out->Y_O_dot);
}

static void dynamics(const WheelScene* scene, const double* y, WheelDynamics* out) {
  Body b = body_of(scene, y, y[CHI]);
  Answer a = respond(scene, &b);
  out->lambda[0] = a.f_x * b.carrier.cos_psi - a.f_y * b.carrier.sin_psi;
  out->lambda[1] = a.f_x * b.carrier.sin_psi + a.f_y * b.carrier.cos_psi;
  out->lambda[2] = a.N;
  out->tau = a.tau;
  set_accelerations(scene, &b.carrier, a.omega_1_dot, a.omega_2_dot, a.omega_3_dot, out);
}

static void reduce(const double* y, double* reduced) { memcpy(reduced, y, sizeof(double) * WHEEL_SLIDING_STATES); }

static void stop_spin(const WheelParameters* wheel, double* y) { wheel_reduced.stop_spin(wheel, y); }

static void grip(const WheelParameters* wheel, double* y) {
  (void)wheel;
  y[SPEED] = y[CHI] = 0;
}

const WheelFormulation wheel_sliding = {"sliding", WHEEL_SLIDING_STATES, start, derivative, OMEGA_3, THETA,
                                        SPEED,     kinematics,           pose,  dynamics,   reduce,  stop_spin,
                                        grip};
