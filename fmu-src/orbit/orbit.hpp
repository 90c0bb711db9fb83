// A wheel unfolded: without friction, brake and load, and with J_x = J_y or on a wheel carrier, half a swing
// holds the whole motion.
//
// Along the motion omega_2 and omega_3 are functions of theta alone (Chaplygin), so theta swings to and fro between two
// turning points (omega_1 = theta_dot = 0). The equations are the same with time reversed: about a turning point T,
// theta, omega_2 and omega_3 are even in t - T and omega_1 is odd; psi and phi are odd about their values at T, and the
// path of O is its own mirror image. The motion is integrated up to the second turning point T2; every later instant is
// read from the half swing between T1 and T2. The error grows in proportion to t, and the cost does not grow.
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
// From the question to the answer, each type written in one place and constant from then on, but for what a track and
// an entry remember of the place read last:
//
//   FreeMotion     by the owner: the problem and its start
//   Course         by stepping along it (building.cpp): the integrated motion, in its own frame, on one of two paths:
//     Track          the polynomials of its steps
//     Circle         steady motion, a circle or a straight line, of which any piece is a half
//   Swing          by its constructor, of a course: the half swing and the terms from which any other one follows
//   Entry          by Orbit::enter: the run on a swing, from its own heading, roll angle and place
//     Half, Pose     one half, and how it lies in fixed axes
//
// State of the reduced form (wheel_equations.h). Time in s, zero at the start. Path of O as X_O + i Y_O.
#pragma once

#include <array>
#include <complex>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <variant>

#include "solver.hpp"
#include "wheel_equations.h"

namespace orbit {

using Complex = std::complex<double>;
inline constexpr int states = WHEEL_REDUCED_STATES;

inline Complex place_of(const double* y) { return {y[WHEEL_X_O], y[WHEEL_Y_O]}; }
inline void set_place(double* y, Complex place) {
  y[WHEEL_X_O] = place.real();
  y[WHEEL_Y_O] = place.imag();
}

// A motion to be unfolded: a problem of the reduced form of a wheel, its start, and how far it may be read.
struct FreeMotion {
  solver::Problem problem;
  double tolerance;
  double time_scale;  // s, of the wheel's motion
  // What follows from an event at t and y, for the problem's owner to decide; where the motion bends it cannot be
  // unfolded. From then on the owner may answer the problem otherwise, as to which side of a limit is watched.
  solver::Consequence (*on_event)(void* owner, int event, double t, double* y);
  const double* y0;
  double most_angle;  // rad, by which psi or phi may turn
  // The numbers that the motion follows from, but for psi, phi and place of its start; at most longest_key.
  std::span<const double> key;
};
inline constexpr std::size_t longest_key = 64;

// The polynomials of the steps of a motion.
class Track {
 public:
  // The next step, with its polynomial; false where the track is full, the polynomial has too high a degree for it, or
  // there is no memory.
  bool add(const solver::Step& step);

  // (t, between the first instant and the last) => y
  void read(double t, double* y) const;

 private:
  static constexpr int more_pieces = 32, most_pieces = 32 * more_pieces, degree = 7;

  struct Piece {
    double start, end, c[degree + 1][states];  // as in Step
  };

  std::unique_ptr<Piece, void (*)(void*)> pieces_{nullptr, std::free};  // a vector without memory would throw
  int count_ = 0;
  mutable int latest_ = 0;  // the piece read last
};

// Steady motion: a circle or a straight line, of which any piece is a half.
struct Circle {
  double y0[states], rate[states];  // at the start, where psi, phi and place are zero

  void read(double t, double* y) const;
};

// The integrated motion: psi, phi, X_O and Y_O are zero at its start. Without a path: none. On a circle T1 = 0, and T2
// ends a piece of it.
struct Course {
  Course() { first_times.fill(solver::never); }

  std::variant<std::monostate, Track, Circle> path;  // from the start past T2
  double T1 = 0, T2 = 0;
  std::optional<int> ending;  // the event that ends the motion at T2, in its first swing; none: it never ends
  // When an event after which the motion goes on first occurs, and the first of all; infinite: never. It recurs in
  // each mirror image.
  std::array<double, solver::max_watched + 1> first_times;
  double first_time = solver::never;
  solver::Counters counters = {};  // of the integration; zero for a wheel in steady motion

  bool exists() const { return !std::holds_alternative<std::monostate>(path); }
  double half_period() const { return T2 - T1; }  // s, of theta's swing, or the length of the piece
  // (0 <= t <= T2, of a steady motion any t) => y in the frame of the course
  void read(double t, double* y) const;
};

// How a part of the course lies in fixed axes: what is added to its psi and phi, where its path begins, and how far the
// path is turned.
struct Pose {
  double psi = 0, phi = 0;
  Complex place = 0, rotation = 1;

  // (y in the frame of the course, way of O from the beginning of the part) => y in fixed axes
  void carry(Complex way, double* y) const;
};

// The half swing from T1 + k L to T1 + (k + 1) L, L = T2 - T1.
struct Half {
  double begin = 0, next = 0;
  bool mirrored = false;
  Pose pose = {};
};

// How a run lies on a swing.
struct Entry {
  Pose start = {};
  double until = -1;         // s, how far the owner may read it; below zero: no run has entered
  mutable Half latest = {};  // the half read last, a function of its number alone
};

class Swing {
 public:
  Swing() = default;  // of no course
  explicit Swing(Course&& course);

  const Course& course() const { return course_; }
  // (start of a run, rad by which psi or phi may turn) => the run
  Entry entry_at(const double* y0, double most_angle) const;
  // (0 <= t <= until) => y
  void read(const Entry& entry, double t, double* y) const;
  const Half& half_of(const Entry& entry, double t) const;

 private:
  double begin_of(double k) const { return course_.T1 + k * course_.half_period(); }
  Half half_at(double k, const Pose& start) const;

  Course course_;
  // Of the half from T1 to T2, unless the motion ends: its ends, and the terms of the sums over halves.
  double at_T1_[states] = {}, at_T2_[states] = {};
  double psi_growth_ = 0, phi_growth_ = 0;    // rad, from T1 to T2
  double delta_ = 0;                          // that of psi less the nearest multiple of pi
  double pair_advance_ = 0;                   // m, factor of the sum over pairs of halves
  Complex rotation_at_T1_, mirror_rotation_;  // exp(i psi(T1)), exp(2 i psi(T2))
  Complex displacement_;                      // from O(T1) to O(T2), seen along psi(T1)
};

// enter, read as often as wanted from 0 to until(), leave; and so on with the next run.
class Orbit {
 public:
  // Integrates the motion by DOP853, unless it has the key of the one integrated last. The solver is used for it, and
  // dropped. The swing is a function of problem, tolerance, theta and the rates in y0 alone: bit-identical in every
  // process and from every place and heading. False, and the orbit is left, where the motion is refused (building.cpp):
  // the caller then steps through it from its start.
  bool enter(const FreeMotion& motion, solver::Solver& solver);
  void leave() { entry_ = {}; }

  // s; below zero where the orbit is left
  double until() const { return entry_.until; }
  // Of an orbit that is entered.
  const Course& course() const { return swing_.course(); }
  void read(double t, double* y) const { swing_.read(entry_, t, y); }

 private:
  // The motion integrated last, if there was one; of no course where it was refused.
  bool has_integrated_ = false;
  std::array<double, longest_key> key_ = {};
  Swing swing_;
  Entry entry_;  // on it, of the present run
};

}  // namespace orbit
