// Hermite's interpolation by divided differences with each node taken twice.
#include "track.hpp"

#include <algorithm>
#include <new>

namespace wheel {

bool Track::begin(double t, const double* y, const double* y_dot) {
  if (!table_) table_.reset(new (std::nothrow) Table);
  pieces_ = nodes_ = open_ = latest_ = 0;
  return table_ && add(t, y, y_dot);
}

bool Track::add(double t, const double* y, const double* y_dot) {
  if (nodes_ > 0 && !(t > table_->nodes[nodes_ - 1].t)) return true;
  Node& node = table_->nodes[nodes_++];
  node.t = t;
  std::copy_n(y, states, node.y);
  std::copy_n(y_dot, states, node.y_dot);
  if (nodes_ - open_ < most_nodes || thin(open_, nodes_ - 1)) return true;
  if (pieces_ == most_pieces - 1) return false;  // the last one is for `finish`
  interpolate(open_, nodes_ - 1);
  // What is left behind serves `finish`.
  Node* nodes = table_->nodes;
  std::copy(nodes + nodes_ - most_nodes, nodes + nodes_, nodes);
  nodes_ = most_nodes;
  open_ = most_nodes - 1;
  return true;
}

// A last piece of few steps reaches back over nodes of the one before it.
void Track::finish() {
  if (pieces_ > 0 && open_ == nodes_ - 1) return;
  while (thin(std::max(0, nodes_ - most_nodes), nodes_ - 1)) {
  }
  interpolate(std::max(0, nodes_ - most_nodes), nodes_ - 1);
}

// Nodes that lie too close together, as the first ones of a run do, magnify rounding: takes out the one that is closest
// to its neighbours, and keeps the first and the last. False where they are spread well.
bool Track::thin(int first, int last) {
  constexpr double least_gap = 0.15;
  Node* nodes = table_->nodes;
  int closest = -1;
  double least = least_gap * (nodes[last].t - nodes[first].t);
  for (int i = first; i < last; ++i) {
    const double gap = nodes[i + 1].t - nodes[i].t;
    if (gap < least) least = gap, closest = i;
  }
  if (closest < 0 || last - first < 2) return false;
  if (closest == first) ++closest;
  std::copy(nodes + closest + 1, nodes + nodes_, nodes + closest);
  --nodes_;
  if (closest < open_) --open_;
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

}  // namespace wheel
