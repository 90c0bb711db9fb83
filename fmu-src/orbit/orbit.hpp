// The free wheel unfolded: without friction, brake and load, and with J_x = J_y or on a wheel carrier, half a nutation
// holds the whole motion.
//
// Along the motion omega_2 and omega_3 are functions of theta alone (Chaplygin), so theta swings to and fro between two
// turning points (omega_1 = theta_dot = 0). The equations are the same with time reversed: about a turning point T,
// theta, omega_2 and omega_3 are even in t - T and omega_1 is odd; psi and phi are odd about their values at T, and the
// path of O is its own mirror image. The motion is integrated up to the second turning point T2; every later instant is
// read from the half nutation between T1 and T2. The error grows in proportion to t, and the cost does not grow.
//
// Heading, roll angle and place of the start are symmetries too: the motion is integrated from zeros, and psi, phi, X_O
// and Y_O of the start are added when it is read. Many turns at the start cost no digits.
//
//     theta
//       |       T1              T3
//       |     .    .          .    .            integrated: from 0 past T2
//       |   .        .      .        .          T1 to T2:   L, the half that is kept
//       |  .           .  .            .        T2 to T3:   its mirror image about T2, turned and displaced
//       +--0-----------T2----------------- t    from T3 on: images of images, L each
//
// State of the reduced form (wheel_equations.h). Time in s, zero at the start.
#pragma once

#include <complex>
#include <cstdlib>
#include <memory>

#include "solver.hpp"
#include "wheel_equations.h"

namespace orbit {

// A motion that was integrated once, kept to be read at any instant: the polynomials of its steps.
class Track {
 public:
  static constexpr int states = WHEEL_REDUCED_STATES;

  // The next step, with its polynomial; false where the track is full or there is no memory for it.
  bool add(const solver::Step& step);

  // (t, between the first instant and the last) => y
  void read(double t, double* y) const;

 private:
  static constexpr int more_pieces = 32, most_pieces = 32 * more_pieces, degree = 7;

  struct Piece {
    double start, end, c[degree + 1][states];  // as in Step
  };

  std::unique_ptr<Piece, void (*)(void*)> pieces_{nullptr, std::free};
  int count_ = 0;
  mutable int latest_ = 0;  // the piece read last
};

// A motion to be unfolded: a problem of the reduced form of a wheel, its start, and how far it may be read.
struct FreeMotion {
  // What follows from an event at t and y, for the owner to decide. Where the motion bends it cannot be unfolded.
  using OnEvent = solver::Consequence (*)(void* owner, int event, double t, double* y);

  solver::Problem problem;
  double tolerance;
  OnEvent on_event;
  const double* y0;
  double most_angle;  // rad, by which psi or phi may turn
};

// enter, read as often as wanted from 0 to until(), leave; and so on with the next run.
class Orbit {
 public:
  // unfolded: the motion never ends.
  // steady: a circle or a straight line for ever.
  // ended: by event(), in the first nutation.
  // refused: no two turning points within a fixed number of steps, a swing no larger than errors, or rates
  //   that have not the symmetry. The caller then steps through the motion from its start.
  enum class Result { refused, unfolded, steady, ended };

  // Integrates the motion by DOP853, unless it is `known`: the one integrated last, but for psi, phi and place of its
  // start. The solver has to be started anew before anything else is asked of it. The integrated motion is a function
  // of problem, tolerance, theta and the rates in y0 alone: bit-identical in every process and from every place and
  // heading. False where the motion is refused, or the right-hand side depends on heading, roll angle or place.
  bool enter(const FreeMotion& motion, bool known, solver::Solver& solver);
  void leave() { until_ = nowhere; }

  // (0 <= t <= until()) => y
  void read(double t, double* y) const;
  double until() const { return until_; }  // s
  bool is_entered() const { return until_ != nowhere; }
  Result result() const { return result_; }
  bool ends() const { return result_ == Result::ended; }
  int event() const { return event_; }
  // What the integration took; zero for a wheel in steady motion.
  const solver::Counters& counters() const { return counters_; }
  double half_period() const { return T2_ - T1_; }  // s, of theta's nutation; unfolded only

  // s, when an event after which the motion goes on first occurs, and the first of all; infinite: never. It recurs in
  // each mirror image.
  double first_time_of(int event) const { return first_times_[event]; }
  double first_time() const { return first_time_; }

 private:
  static constexpr double nowhere = -solver::never;
  using Complex = std::complex<double>;
  static constexpr int states = Track::states;
  static Complex place_of(const double* y) { return {y[WHEEL_X_O], y[WHEEL_Y_O]}; }
  static void set_place(double* y, Complex place) {
    y[WHEEL_X_O] = place.real();
    y[WHEEL_Y_O] = place.imag();
  }

  // The half nutation from T1 + k L to T1 + (k + 1) L, L = T2 - T1: where O begins, and how far the integrated path,
  // psi and phi are turned.
  struct Half {
    double begin = 0, next = 0;
    bool mirrored = false;
    double psi_sum = 0, phi_sum = 0;
    Complex place = 0, rotation = 1;
  };

  // building.cpp: `build` integrates, `begin` places the start
  void build(const FreeMotion& motion, solver::Solver& solver);
  bool begin(const FreeMotion& motion);
  template <class Map>
  bool maps(const solver::Problem& problem, double t, double t_image, const Map& map) const;
  bool is_steady(const solver::Problem& problem, const double* y0);
  bool keep_steady(const solver::Problem& problem, const double* y0, const double* rate, double length);
  Result follow(const solver::Problem& problem, FreeMotion::OnEvent on_event, const double* y0, solver::Solver& solver);
  solver::Outcome step(const solver::Problem& problem, FreeMotion::OnEvent on_event, solver::Solver& solver);
  static double turning_point(const solver::Problem& problem, double before, solver::Solver& solver);
  bool unfold(const solver::Problem& problem, Result kind);
  bool is_mirrored(const solver::Problem& problem, double since) const;
  // orbit.cpp
  void take_half();
  void read_circle(double t, double* y) const;
  void read_integrated(double t, double* y) const;
  static void to_fixed(const Half& half, Complex way, double* y);

  double begin_of(double k) const { return T1_ + k * (T2_ - T1_); }
  Half half_at(double k) const;
  const Half& half_of(double t) const;

  // Written by `build`: the integrated motion, in its own frame.
  Result result_ = Result::refused;
  Track track_;                                                               // from the start past T2
  double steady_rate_[states] = {};                                           // steady motion: at the start
  double T1_ = 0, T2_ = 0;                                                    // T2: where the motion ends, if it does
  int event_ = 0;                                                             // by which it ends
  double first_times_[solver::max_watched + 1], first_time_ = solver::never;  // s; by event
  solver::Counters counters_ = {};
  // By `take_half`, of the half from T1 to T2: its ends, and the terms of the sums over halves.
  double at_T1_[states] = {}, at_T2_[states] = {};
  double psi_growth_ = 0, phi_growth_ = 0;    // rad, from T1 to T2
  double delta_ = 0;                          // that of psi less the nearest multiple of pi
  double pair_ = 0;                           // factor of the sum over pairs of halves
  Complex rotation_at_T1_, mirror_rotation_;  // exp(i psi(T1)), exp(2 i psi(T2))
  Complex displacement_;                      // from O(T1) to O(T2), seen along psi(T1)
  // By `begin`: psi, phi and place of the start, from which the motion up to T2 is seen; how far it can be read.
  Half start_;
  double until_ = nowhere;
  // By `half_of`: the half read last, a function of its number alone.
  mutable Half latest_half_;
};

}  // namespace orbit
