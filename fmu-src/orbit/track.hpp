// A motion that was integrated once, kept to be read at any instant: polynomials through states and rates at the ends
// of steps (Hermite), each over about five steps, in Newton's form. That is as exact as the solver's own dense output
// and takes a fifth of its memory.
//
// State of the reduced form, 8 numbers; time in s.
#pragma once

#include <cstdlib>
#include <memory>

namespace orbit {

class Track {
 public:
  static constexpr int states = 8;

  // An empty track from y at t on; false without memory for it.
  bool begin(double t, const double* y, const double* y_dot);
  // The end of a step; false where the track is full.
  bool add(double t, const double* y, const double* y_dot);
  // Nothing more follows: from here on all of it can be read.
  void finish();

  // y (out) at t, between the first instant and the last.
  void read(double t, double* y) const;

 private:
  static constexpr int most_pieces = 112, most_nodes = 6, terms = 2 * most_nodes;

  struct Node {
    double t, y[states], y_dot[states];
    bool spans_two;  // the gap before it holds two steps
  };
  // y = c_0 + (x - x_0) (c_1 + (x - x_0) (c_2 + (x - x_1) (...))) up to the instant `until`, x = (t - begin) * inverse.
  struct Piece {
    double until, begin, inverse, x[most_nodes], c[terms][states];
  };
  struct Table {
    Piece pieces[most_pieces];
    Node nodes[2 * most_nodes];
  };

  void thin_start();
  bool ends_piece() const;
  bool close(int last);
  void interpolate(int first, int last);

  std::unique_ptr<Table, void (*)(void*)> table_{nullptr, std::free};
  int pieces_ = 0, nodes_ = 0;
  int open_ = 0;            // the node at which the last piece ended
  mutable int latest_ = 0;  // the piece read last
};

}  // namespace orbit
