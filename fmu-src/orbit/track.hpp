// A motion that was integrated once, kept to be read at any instant: the polynomials of its steps.
//
// State of the reduced form; time in s.
#pragma once

#include <cstdlib>
#include <memory>

#include "step.hpp"
#include "wheel_equations.h"

namespace orbit {

class Track {
 public:
  static constexpr int states = WHEEL_REDUCED_STATES;

  // The next step, with its polynomial; false where the track is full or there is no memory for it.
  bool add(const solver::Step& step);

  // y (out) at t, between the first instant and the last.
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

}  // namespace orbit
