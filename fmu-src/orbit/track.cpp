// Hermite's interpolation by divided differences with each node taken twice.
#include "track.hpp"

#include <algorithm>
#include <cmath>

namespace orbit {

// Smallest distance of two nodes, as a fraction of the length of a piece. Close nodes magnify rounding errors: 50 times
// at 0.06, a million times at 0.02. The first steps of a run are much smaller than the motion needs, so nodes of the
// first piece are kept farther apart.
static constexpr double least_gap = 0.06, least_first_gap = 0.14;
// As a fraction of the largest distance of two nodes: where steps shrink this fast the motion changes its character,
// and one polynomial must not span the change.
static constexpr double sudden = 0.25;

bool Track::begin(double t, const double* y, const double* y_dot) {
  if (!table_) table_.reset(static_cast<Table*>(std::calloc(1, sizeof(Table))));
  pieces_ = nodes_ = open_ = latest_ = 0;
  return table_ && add(t, y, y_dot);
}

bool Track::add(double t, const double* y, const double* y_dot) {
  Node* nodes = table_->nodes;
  const double step = nodes_ > 0 ? t - nodes[nodes_ - 1].t : 1;
  if (!(step > 0)) return true;
  const double before = nodes_ > 1 ? nodes[nodes_ - 1].t - nodes[nodes_ - 2].t : 0;
  const bool spans_two = nodes_ - 1 > open_ && !nodes[nodes_ - 1].spans_two && step > 0.5 * before && step < 2 * before;
  if (spans_two) --nodes_;
  Node& node = nodes[nodes_++];
  node.t = t;
  node.spans_two = spans_two;
  std::copy_n(y, states, node.y);
  std::copy_n(y_dot, states, node.y_dot);
  if (pieces_ == 0) thin_start();
  return spans_two || !ends_piece() || close(nodes_ - 2);
}

void Track::finish() { close(nodes_ - 1); }

// Whether the last node is one too many for the open piece, or too close to the others, or too far from them.
bool Track::ends_piece() const {
  const Node* nodes = table_->nodes;
  if (nodes_ - open_ < 3) return false;
  if (nodes_ - open_ > most_nodes) return true;
  const double last = nodes[nodes_ - 1].t - nodes[nodes_ - 2].t;
  double least = last, largest = last;
  for (int i = open_; i < nodes_ - 1; ++i) {
    least = std::fmin(least, nodes[i + 1].t - nodes[i].t);
    largest = std::fmax(largest, nodes[i + 1].t - nodes[i].t);
  }
  return last < sudden * largest || least < least_gap * (nodes[nodes_ - 1].t - nodes[open_].t);
}

void Track::thin_start() {
  Node* nodes = table_->nodes;
  while (nodes_ > 2 && nodes[1].t - nodes[0].t < least_first_gap * (nodes[nodes_ - 1].t - nodes[0].t)) {
    std::copy(nodes + 2, nodes + nodes_, nodes + 1);
    --nodes_;
  }
}

// A piece over the open nodes up to `last`. Where these are few, nodes of the piece before are used too.
bool Track::close(int last) {
  if (pieces_ == most_pieces) return false;
  Node* nodes = table_->nodes;
  const double least = least_gap * (nodes[last].t - nodes[open_].t);
  int first = open_;
  while (first > 0 && last - first + 1 < most_nodes && nodes[first].t - nodes[first - 1].t >= least) --first;
  interpolate(first, last);
  const int passed = std::max(0, last + 1 - most_nodes);
  std::copy(nodes + passed, nodes + nodes_, nodes);
  nodes_ -= passed;
  open_ = last - passed;
  return true;
}

void Track::interpolate(int first, int last) {
  const Node* nodes = table_->nodes;
  Piece& piece = table_->pieces[pieces_++];
  const int count = last - first + 1;
  piece = {};
  piece.until = nodes[last].t;
  piece.begin = nodes[first].t;
  const double length = nodes[last].t - nodes[first].t;
  piece.inverse = length > 0 ? 1 / length : 0;
  for (int i = 0; i < count; ++i) {
    piece.x[i] = (nodes[first + i].t - piece.begin) * piece.inverse;
    std::copy_n(nodes[first + i].y, states, piece.c[2 * i]);
    std::copy_n(nodes[first + i].y, states, piece.c[2 * i + 1]);
  }
  for (int order = 1; order < 2 * count; ++order)
    for (int k = 2 * count - 1; k >= order; --k) {
      const Node& node = nodes[first + k / 2];
      if (order == 1 && k % 2 != 0) {
        for (int i = 0; i < states; ++i) piece.c[k][i] = node.y_dot[i] * length;
      } else {
        const double inverse = 1 / (piece.x[k / 2] - piece.x[(k - order) / 2]);
        for (int i = 0; i < states; ++i) piece.c[k][i] = (piece.c[k][i] - piece.c[k - 1][i]) * inverse;
      }
    }
}

void Track::read(double t, double* y) const {
  const Piece* pieces = table_->pieces;
  const bool found = t <= pieces[latest_].until && (latest_ == 0 || t > pieces[latest_ - 1].until);
  if (!found) {
    const auto before = [](const Piece& piece, double instant) { return piece.until < instant; };
    latest_ = static_cast<int>(std::lower_bound(pieces, pieces + pieces_ - 1, t, before) - pieces);
  }
  const Piece& piece = pieces[latest_];
  const double x = (t - piece.begin) * piece.inverse;
  double sum[states];
  std::copy_n(piece.c[terms - 1], states, sum);
  for (int k = terms - 2; k >= 0; --k) {
    const double off = x - piece.x[k / 2];
    for (int i = 0; i < states; ++i) sum[i] = sum[i] * off + piece.c[k][i];
  }
  std::copy_n(sum, states, y);
}

}  // namespace orbit
