/* The wheel that slides, reduced form: Newton and Euler about O for any principal moments of inertia; the ground's
 * horizontal force is mu_slide N against the slip, and only the height of O is a constraint. Non-spinning frame e1, e2,
 * e3; x along e1, y horizontal to the left of it. docs/equations.md derives every line. */
#include <string.h>

#include "axle_law.h"
#include "frame.h"

/* What acts apart from the ground's friction, or its change. */
typedef struct Action {
  Moment M;        /* N m, external less gyroscopic moment */
  double N_still;  /* N, normal force for omega_1_dot = 0 */
  double a_x, a_y; /* m/s2, rate of the slip without friction and omega_dot */
  double guide[2]; /* rad/s2, omega_1_dot and omega_2_dot that a wheel carrier gives */
  double brake;    /* N m, of the law about the axle */
} Action;

static const Action none = {.brake = 0};

/* One state under a load. */
typedef struct Body {
  Frame frame;
  Inertia inertia;
  Action given;
  double h, l; /* m, height of O, r_0 sin(theta) + r, and its rate per unit of omega_1 */
  double per_mass, per_spin, per_22, per_tilt; /* inverse of m, J_z, I_22, and of I_11 - p^2 / I_22 + m l^2 */
  double g_x, g_y;                             /* what a unit of the ground's horizontal force adds to N */
  double N_free;                               /* N, normal force without sliding friction */
  double mu;                                   /* coefficient of the ground's friction; zero where it pulls */
  AxleLaw law;                                 /* for kappa = 1; its brake is part of what is given */
  double kappa;                                /* tau is that of the law times kappa */
  int guided;                                  /* no moment turns the wheel across its axle: a wheel carrier does */
} Body;

/* What follows. */
typedef struct Response {
  Accelerations a;
  double u_x, u_y; /* m/s2, rate of the slip without the turning of the axes */
} Response;

/* (action, horizontal force f of the ground) => omega_dot, N, tau, rate of the slip; linear in both:
 * J_z omega_3_dot = M_3 + rho f_x + tau, N = N_still + m l omega_1_dot, and unless a wheel carrier gives these two
 *   [ I_11 + m l^2  p    ]                [ M_1 - l N_still + h f_y ]
 *   [ p             I_22 ] {omega_dot} =  [ M_2 - eta f_x           ] */
static inline Response response_of(const WheelParameters* w, const Body* b, const Action* on, double f_x, double f_y) {
  const Frame* f = &b->frame;
  double p = b->inertia.p, M_2 = on->M.M_2 - f->eta * f_x, M_3 = on->M.M_3 + f->rho * f_x;
  Accelerations a = {.omega_1_dot = on->guide[0], .omega_2_dot = on->guide[1]};
  if (!b->guided) {
    a.omega_1_dot = (on->M.M_1 - b->l * on->N_still + b->h * f_y - p * b->per_22 * M_2) * b->per_tilt;
    a.omega_2_dot = (M_2 - p * a.omega_1_dot) * b->per_22;
  }
  a.N = on->N_still + w->m * b->l * a.omega_1_dot;
  const AxleLaw law = {.lever = b->law.lever, .brake = on->brake};
  a.tau = b->law.held ? -M_3 : axle_moment_of(&law, a.N) * b->kappa;
  a.omega_3_dot = b->law.held ? 0 : (M_3 + a.tau) * b->per_spin;
  return (Response){
      .a = a,
      .u_x = on->a_x + f_x * b->per_mass - f->eta * a.omega_2_dot + f->rho * a.omega_3_dot,
      .u_y = on->a_y + f_y * b->per_mass + b->h * a.omega_1_dot,
  };
}

/* (scene, y) => geometry, inertia, what acts apart from the sliding friction */
INLINED Body body_of(const WheelScene* scene, const double* y, int guided) {
  const WheelParameters* w = &scene->wheel;
  const WheelLoad* load = &scene->load;
  Body b = {.frame = frame_of(w, y), .inertia = inertia_of(w, y[WHEEL_PHI])};
  const Frame* f = &b.frame;
  Action* a = &b.given;
  double omega_1_2 = f->omega_1 * f->omega_1, p = b.inertia.p, F_x, F_y;
  road_force(scene, f, &F_x, &F_y);
  b.h = w->r_0 * f->sin_theta + w->r;
  b.l = w->r_0 * f->cos_theta;
  b.per_mass = 1 / w->m;
  b.per_spin = 1 / w->J_z;
  b.guided = guided;
  b.per_22 = 1 / b.inertia.I_22;
  b.per_tilt = 1 / (b.inertia.I_11 - p * p * b.per_22 + w->m * b.l * b.l);
  double lift = guided ? 0 : w->m * b.l * b.per_tilt;
  b.g_x = lift * (f->eta * p * b.per_22);
  b.g_y = lift * b.h;
  a->guide[0] = load->guide[1];
  a->guide[1] = guided_rate(f, load->guide[0]);
  a->M = moment_of(scene, &b.inertia, f);
  a->N_still = w->m * (w->g_n - w->r_0 * f->sin_theta * omega_1_2) - load->F[2];
  a->a_x = F_x * b.per_mass + f->omega_1 * (w->r * f->sin_theta * f->omega_2 + f->eta * f->omega_3 - f->psi_dot * b.h);
  a->a_y = F_y * b.per_mass + b.l * omega_1_2 - f->psi_dot * f->v_1;
  b.kappa = kappa_of(&scene->friction, f->omega_3);
  b.law = axle_law_of(scene, 1, 1);
  a->brake = b.law.brake;
  b.N_free = response_of(w, &b, a, 0, 0).a.N;
  /* The sign of N is that without sliding friction as long as there is room. */
  if (scene->ground == WHEEL_GROUND_PULLS || (scene->ground == WHEEL_GROUND_BY_FORCE && b.N_free <= 0)) return b;
  b.mu = scene->mu_slide;
  b.law = axle_law_of(scene, 1, 0);
  return b;
}

/* (direction d of the slip) => what friction against it leaves of 1: N = N_free / room */
static inline double room_of(const Body* b, double d_x, double d_y) {
  return 1 + b->mu * (b->g_x * d_x + b->g_y * d_y);
}

/* (direction d of the slip) => motion under mu N against it */
static inline Response slide(const WheelParameters* w, const Body* b, double d_x, double d_y) {
  double force = b->mu * b->N_free / room_of(b, d_x, d_y);
  Response response = response_of(w, b, &b->given, -force * d_x, -force * d_y);
  response.a = if_lawful(response.a);
  return response;
}

/* (direction chi of the slip) => N, room, growth, turn, settling */
static WheelSlip slip_of(const WheelParameters* w, const Body* b, double chi) {
  double d_x = cos(chi), d_y = sin(chi), room = room_of(b, d_x, d_y);
  Response m = slide(w, b, d_x, d_y);
  double N = m.a.N, N_turn = b->mu * N * (b->g_x * d_y - b->g_y * d_x) / room; /* dN/d(chi) */
  Response turned = response_of(w, b, &none, -b->mu * (N_turn * d_x - N * d_y), -b->mu * (N_turn * d_y + N * d_x));
  double growth = m.u_x * d_x + m.u_y * d_y;
  return (WheelSlip){
      .N = N,
      .room = room,
      .growth = growth,
      .turn = m.u_y * d_x - m.u_x * d_y,
      .settling = growth - (turned.u_y * d_x - turned.u_x * d_y),
  };
}

WheelSlip wheel_slip(const WheelScene* scene, const double* reduced, double chi) {
  Body b = body_of(scene, reduced, scene->guided);
  return slip_of(&scene->wheel, &b, chi);
}

/* Without the pole where room = 0 it is a trigonometric polynomial of degree 2. */
static double turning(const WheelParameters* w, const Body* b, double chi) {
  WheelSlip slip = slip_of(w, b, chi);
  return slip.turn * slip.room;
}

/* turning > 0 at lo, <= 0 at hi => chi between them, by halving, to the last digit */
static double zero_of_turning(const WheelParameters* w, const Body* b, double lo, double hi) {
  for (int i = 0; i < 60; ++i) {
    double middle = 0.5 * (lo + hi);
    if (turning(w, b, middle) > 0)
      lo = middle;
    else
      hi = middle;
  }
  return 0.5 * (lo + hi);
}

/* From the direction against the force of rolling to both sides in turn, until a zero of the turning is found where
 *   it falls: a slip that turns a little comes back;
 *   growth >= 0, to rounding: the slip grows;
 *   room and N are positive;
 * or all parts of the circle are searched: NaN. */
static double search_direction(const WheelParameters* w, const Body* b, double against, double least, int parts) {
  const double part = 2 * 3.141592653589793 / parts;
  for (int i = 0; i < parts; ++i) {
    double lo = against + part * ((i % 2 ? -(i + 1) / 2 : i / 2) - 0.5), hi = lo + part;
    if (!(turning(w, b, lo) > 0 && turning(w, b, hi) <= 0)) continue;
    double chi = zero_of_turning(w, b, lo, hi);
    WheelSlip slip = slip_of(w, b, chi);
    if (slip.growth >= least && slip.room > WHEEL_LEAST_ROOM && slip.N > 0) return chi;
  }
  return NAN;
}

/* In ever smaller parts, since a zero where the turning rises may lie close by; not so without friction. */
double wheel_slip_direction(const WheelScene* scene, const double* reduced) {
  const double rounding = 1e-9;
  const WheelParameters* w = &scene->wheel;
  Body b = body_of(scene, reduced, scene->guided);
  Response free = response_of(w, &b, &b.given, 0, 0), x = response_of(w, &b, &none, 1, 0),
           y = response_of(w, &b, &none, 0, 1);
  /* against the force of rolling, for which u_x = u_y = 0; its size does not matter */
  double against = wheel_angle_of(y.u_y * free.u_x - y.u_x * free.u_y, x.u_x * free.u_y - x.u_y * free.u_x);
  double least = -rounding * (fabs(free.u_x) + fabs(free.u_y)), chi = NAN;
  const int finest = b.mu > 0 ? 18000 : 180;
  for (int parts = 180; isnan(chi) && parts <= finest; parts *= 10)
    chi = search_direction(w, &b, against, least, parts);
  return chi;
}

static void start(const WheelParameters* wheel, const WheelMotion* motion, double* y) {
  memset(y, 0, sizeof(double) * WHEEL_SLIDING_STATES);
  wheel_reduced.start(wheel, motion, y);
  y[WHEEL_SLIP] = sqrt(motion->slip_x * motion->slip_x + motion->slip_y * motion->slip_y);
  y[WHEEL_CHI] = wheel_angle_of(motion->slip_x, motion->slip_y);
}

/* The velocity of O: that of rolling, and the slip u. */
static inline void set_velocity(const Frame* f, double h, double u_x, double u_y, double* X_dot, double* Y_dot) {
  to_fixed(f, f->v_1 + u_x, u_y - h * f->omega_1, X_dot, Y_dot);
}

/* Returns N, infinite where the wheel jams. */
INLINED double rates(const WheelScene* scene, const double* y, double* y_dot, int guided) {
  Sines chi = wheel_sines(y[WHEEL_CHI]); /* first: behind the call nothing is left in registers */
  Body b = body_of(scene, y, guided);
  const Frame* f = &b.frame;
  double d_x = chi.cosine, d_y = chi.sine, X_dot, Y_dot;
  Response m = slide(&scene->wheel, &b, d_x, d_y);
  double chi_dot = y[WHEEL_SLIP] == 0 ? 0 : (m.u_y * d_x - m.u_x * d_y) / y[WHEEL_SLIP] - f->psi_dot;
  set_velocity(f, b.h, y[WHEEL_SLIP] * d_x, y[WHEEL_SLIP] * d_y, &X_dot, &Y_dot);
  set_rates(f, &m.a, y_dot);
  put_pair(X_dot, Y_dot, y_dot + WHEEL_X_O);
  put_pair(m.u_x * d_x + m.u_y * d_y, chi_dot, y_dot + WHEEL_SLIP);
  return room_of(&b, d_x, d_y) > WHEEL_LEAST_ROOM ? m.a.N : INFINITY;
}

/* Apart, so that nothing of one is computed for the other. */
__attribute__((noinline)) static double guided_rates(const WheelScene* scene, const double* y, double* y_dot) {
  return rates(scene, y, y_dot, 1);
}

static double derivative(const WheelScene* scene, const double* y, double* y_dot) {
  return scene->guided ? guided_rates(scene, y, y_dot) : rates(scene, y, y_dot, 0);
}

static void kinematics(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  Frame f = frame_of(wheel, y);
  wheel_reduced.kinematics(wheel, y, out);
  Sines chi = wheel_sines(y[WHEEL_CHI]);
  set_velocity(&f, out->Z_O, y[WHEEL_SLIP] * chi.cosine, y[WHEEL_SLIP] * chi.sine, &out->X_O_dot, &out->Y_O_dot);
}

static void dynamics(const WheelScene* scene, const double* y, WheelDynamics* out) {
  Body b = body_of(scene, y, scene->guided);
  Sines chi = wheel_sines(y[WHEEL_CHI]);
  double d_x = chi.cosine, d_y = chi.sine;
  Response m = slide(&scene->wheel, &b, d_x, d_y);
  to_fixed(&b.frame, d_x, d_y, &out->lambda[0], &out->lambda[1]);
  for (int i = 0; i < 2; ++i) out->lambda[i] *= -b.mu * m.a.N;
  set_dynamics(scene, &b.frame, &m.a, out);
}

const WheelFormulation wheel_sliding = {
    .states = WHEEL_SLIDING_STATES,
    .start = start,
    .derivative = derivative,
    .kinematics = kinematics,
    .dynamics = dynamics,
};
