/* Equations of the chassis: a rigid body on one strut and wheel carrier per wheel, which is a guided wheel.fmu.
 * Wheels: fl, fr, rl, rr; the front ones are steered.
 *
 * The body has six degrees of freedom: position and velocity of its centre of mass B in fixed axes (Z up), a unit
 * quaternion, and the angular velocity in body axes (x forward, y left, z up, principal axes of inertia). R turns body
 * axes to fixed axes. The centre of wheel i at rest is p = (x_i, y_i, R_w - h_B), R_w the wheels' radius.
 *
 *   a = R^T (r_O - r_B),  d = a - p,  d_dot = R^T (v_O - v_B) - w x a      displacement of O and its rate, body axes
 *
 * Along x and y of the chassis a bushing holds O, f = -k_h d - c_h d_dot; along z the strut does, with F_i its share of
 * the weight and e the travel beyond the free one:
 *
 *   f_z = -(F_i + k d + c d' + k_stop |e| e + k_bar (d - d_other wheel of the axle))
 *
 * f acts on the wheel, -f on the chassis. The carrier turns with the chassis and the steer angle delta_i to the left:
 * the axle's direction is n = (sin delta_i, -cos delta_i, 0) in body axes, and the wheel gets its heading and tilt as
 * rates,
 *
 *   R n = (sin theta sin psi, -sin theta cos psi, cos theta),   psi_dot_guide = psi' + align (psi - psi_wheel),
 *
 * theta_dot_guide likewise; `align` takes back the angle that the steps leave. The chassis carries the wheel's
 * moments M_guide_1 e1 + M_guide_2 e2, tau_brake e3 and the reaction of the drive.
 *
 * Steering (Ackermann): all wheels turn about one point on the line through the rear wheels. With L from that line to
 * the front wheels, tan delta_i = L tan delta / (L - y_i tan delta). Drive: M_3 = -share M_drive. Until all wheels are
 * received the chassis runs straight on, each strut gives F_i alone, and no carrier turns. */
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <tuple>

#include "model.hpp"

using Eigen::Matrix3d, Eigen::Quaterniond, Eigen::Vector3d;

enum { at_r = 0, at_q = 3, at_v = 7, at_w = 10, at_psi = 13 }; /* states; the last is the heading, not wrapped */
enum { wheels = 4, front = 2 };                                /* the front wheels come first */
enum { at_g = 0, at_share = 3, at_x_R = at_share + wheels, at_L };

struct Body {
  explicit Body(const States& x)
      : q(x[at_q], x[at_q + 1], x[at_q + 2], x[at_q + 3]),
        R(q.normalized().toRotationMatrix()),
        r(x.segment<3>(at_r)),
        v(x.segment<3>(at_v)),
        w(x.segment<3>(at_w)) {}

  Quaterniond q;
  Matrix3d R;
  Vector3d r, v; /* fixed axes */
  Vector3d w;    /* body axes */
};

struct Hub {
  Vector3d arm = Vector3d::Zero(), d = arm, d_dot = arm; /* body axes */
  Vector3d f = arm;                                      /* force on the wheel, body axes */
  Vector3d M = arm;                                      /* moment of the wheel on the chassis, fixed axes */
  double psi_dot = 0, theta_dot = 0;                     /* rates of the carrier, rad/s */
};

using Hubs = std::array<Hub, wheels>;

/* Shares of the weight F_i = p + q x_i + r y_i in balance: sum F_i = m g cos(slope), sum x_i F_i = sum y_i F_i = 0. */
static void weigh(const double* u, double* share) {
  Eigen::Matrix<double, wheels, 3> place;
  for (int i = 0; i < wheels; ++i) place.row(i) << 1, u[x_fl + i], u[y_fl + i];
  const Eigen::FullPivLU<Matrix3d> balance(place.transpose() * place);
  if (!balance.isInvertible()) throw std::invalid_argument("The hubs must not lie on one line.");
  Eigen::Map<Eigen::Vector<double, wheels>> shares(share);
  shares = place * balance.solve(Vector3d(u[m_B] * u[g] * std::cos(u[slope]), 0, 0));
  if (!(shares.array() > 0).all()) throw std::invalid_argument("The centre of mass must lie between the wheels.");
}

void model_derive(const double* u, double* d) {
  const double downhill = -u[g] * std::sin(u[slope]);
  d[at_g] = downhill * std::cos(u[slope_direction]);
  d[at_g + 1] = downhill * std::sin(u[slope_direction]);
  d[at_g + 2] = -u[g] * std::cos(u[slope]);
  weigh(u, d + at_share);
  d[at_x_R] = (u[x_rl] + u[x_rr]) / 2;
  d[at_L] = (u[x_fl] + u[x_fr]) / 2 - d[at_x_R];
  if (d[at_L] <= 0) throw std::invalid_argument("The front wheels must stand ahead of the rear ones.");
}

/* Level, along X at v_start. */
States model_start(const Now& now) {
  States x = States::Zero();
  x[at_r + 2] = now.u[h_B];
  x[at_q] = 1;
  x[at_v] = now.u[v_start];
  return x;
}

struct Steer {
  double angle, rate; /* rad, rad/s; to the left */
};

static Steer steering(const Now& now, int i) {
  const double* u = now.u;
  if (i >= front) return {0, 0};
  const double x = u[x_fl + i] - now.d[at_x_R], y = u[y_fl + i], L = now.d[at_L];
  const double t = std::tan(u[delta]), across = L - y * t, t_i = x * t / across;
  return {std::atan(t_i), x * L * (1 + t * t) / (across * across) / (1 + t_i * t_i) * u[delta_dot]};
}

/* Spring, damper and stops of one strut; positive where it pushes the wheel down. */
static double strut(const double* u, int i, const Hub& hub) {
  const double d = hub.d[2], e = std::fmax(0, std::fabs(d) - u[travel]);
  return u[k_fl + i] * d + u[c_fl + i] * hub.d_dot[2] + std::copysign(u[k_stop] * e * e, d);
}

/* Wheel i at its place, under the share of the weight alone. */
static Hub read_hub(const Now& now, const Body& body, int i) {
  const double* u = now.u;
  const Vector3d r(u[X_O_fl + i], u[Y_O_fl + i], u[Z_O_fl + i]);
  const Vector3d v(u[X_O_dot_fl + i], u[Y_O_dot_fl + i], u[Z_O_dot_fl + i]);
  const double psi = u[psi_fl + i], theta = u[theta_fl + i];
  const double sp = std::sin(psi), cp = std::cos(psi), st = std::sin(theta), ct = std::cos(theta);
  const Vector3d e1(cp, sp, 0), e2(-ct * sp, ct * cp, st), e3(st * sp, -st * cp, ct);
  const Vector3d p(u[x_fl + i], u[y_fl + i], u[R] - u[h_B]);
  const Steer steer = steering(now, i);
  const double sine = std::sin(steer.angle), cosine = std::cos(steer.angle);
  const Vector3d own(sine, -cosine, 0), n = body.R * own;
  const Vector3d n_dot = body.R * (body.w.cross(own) + steer.rate * Vector3d(cosine, sine, 0));
  const double level = n[0] * n[0] + n[1] * n[1];
  Hub hub;
  hub.arm = body.R.transpose() * (r - body.r);
  hub.d = hub.arm - p;
  hub.d_dot = body.R.transpose() * (v - body.v) - body.w.cross(hub.arm);
  hub.f[2] = -now.d[at_share + i];
  const double off = std::remainder(std::atan2(n[0], -n[1]) - psi, 2 * std::numbers::pi);
  hub.psi_dot = (n[0] * n_dot[1] - n[1] * n_dot[0]) / level + u[align] * off;
  hub.theta_dot = -n_dot[2] / std::sqrt(level) + u[align] * (std::acos(n[2]) - theta);
  const double about_axle = u[tau_brake_fl + i] - u[M_drive] * u[drive_fl + i];
  hub.M = -(u[M_guide_1_fl + i] * e1 + u[M_guide_2_fl + i] * e2 + about_axle * e3);
  return hub;
}

static bool all_received(const double* u) {
  return received(u, Z_O_fl) && received(u, Z_O_fr) && received(u, Z_O_rl) && received(u, Z_O_rr);
}

static Hubs read_hubs(const Now& now, const Body& body) {
  const double* u = now.u;
  Hubs hubs{};
  if (!all_received(u)) {
    for (int i = 0; i < wheels; ++i) hubs[i].f[2] = -now.d[at_share + i];
    return hubs;
  }
  for (int i = 0; i < wheels; ++i) {
    hubs[i] = read_hub(now, body, i);
    hubs[i].f.head<2>() = -u[k_h] * hubs[i].d.head<2>() - u[c_h] * hubs[i].d_dot.head<2>();
    hubs[i].f[2] -= strut(u, i, hubs[i]);
  }
  for (const auto& [left, right, k_bar] : {std::tuple{0, 1, u[k_bar_front]}, std::tuple{2, 3, u[k_bar_rear]}}) {
    const double f = k_bar * (hubs[left].d[2] - hubs[right].d[2]);
    hubs[left].f[2] -= f;
    hubs[right].f[2] += f;
  }
  return hubs;
}

/* m v' = F,  J w' = M - w x J w,  q' = q (0, w) / 2; until all wheels are received the body runs straight on. */
States model_rates(const Now& now, const States& x) {
  const Body body(x);
  States x_dot = States::Zero();
  x_dot.segment<3>(at_r) = body.v;
  if (!all_received(now.u)) return x_dot;
  Vector3d F = Vector3d::Zero(), M = Vector3d::Zero(); /* fixed axes; body axes, about B */
  for (const Hub& hub : read_hubs(now, body)) {
    F -= body.R * hub.f;
    M += body.R.transpose() * hub.M - hub.arm.cross(hub.f);
  }
  const Vector3d J(now.u[J_1], now.u[J_2], now.u[J_3]);
  const Quaterniond turned = body.q * Quaterniond(0, body.w[0], body.w[1], body.w[2]);
  x_dot.segment<4>(at_q) << turned.w() / 2, turned.vec() / 2;
  x_dot.segment<3>(at_v) = F / now.u[m_B] + Vector3d(now.d + at_g);
  x_dot.segment<3>(at_w) = (M - body.w.cross(J.cwiseProduct(body.w))).cwiseQuotient(J);
  x_dot[at_psi] = body.R.row(2).dot(body.w);
  return x_dot;
}

/* The integrated heading is within half a turn of the one that R gives, which is wrapped. */
void model_outputs(const Now& now, const States& x, double* y) {
  const double* u = now.u;
  const Body body(x);
  const Hubs hubs = read_hubs(now, body);
  const double heading = std::atan2(body.R(1, 0), body.R(0, 0));
  const Vector3d point(now.d[at_x_R], 0, u[R] - u[h_B]), rear = body.r + body.R * point;
  const Vector3d velocity = body.v + body.R * body.w.cross(point);
  y[X] = body.r[0], y[Y] = body.r[1], y[Z] = body.r[2];
  y[X_R] = rear[0], y[Y_R] = rear[1], y[Z_R] = rear[2];
  y[psi] = x[at_psi] + std::remainder(heading - x[at_psi], 2 * std::numbers::pi);
  y[v] = velocity[0] * std::cos(heading) + velocity[1] * std::sin(heading);
  y[omega] = body.R.row(2).dot(body.w);
  y[roll] = std::asin(body.R(2, 1));
  y[pitch] = -std::asin(body.R(2, 0));
  for (int i = 0; i < wheels; ++i) {
    const Vector3d force = body.R * hubs[i].f;
    y[F_X_fl + i] = force[0];
    y[F_Y_fl + i] = force[1];
    y[F_Z_fl + i] = force[2];
    y[M_3_fl + i] = -u[M_drive] * u[drive_fl + i];
    y[M_brake_fl + i] = u[M_brake] * u[brake_fl + i];
    y[psi_dot_guide_fl + i] = hubs[i].psi_dot;
    y[theta_dot_guide_fl + i] = hubs[i].theta_dot;
    y[d_fl + i] = hubs[i].d[2];
    y[delta_fl + i] = steering(now, i).angle;
  }
}
