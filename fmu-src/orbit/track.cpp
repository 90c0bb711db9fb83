// Pieces in the order of time.
#include "track.hpp"

#include <algorithm>

namespace orbit {

bool Track::add(const solver::Step& step) {
  if (count_ == most_pieces || step.degree > degree) return false;
  if (count_ % more_pieces == 0) {
    Piece* const shorter = pieces_.release();
    void* const longer = std::realloc(shorter, (count_ + more_pieces) * sizeof(Piece));
    pieces_.reset(longer ? static_cast<Piece*>(longer) : shorter);
    if (!longer) return false;
  }
  Piece& piece = pieces_.get()[count_++] = {step.start, step.end, {}};
  for (int k = 0; k <= step.degree; ++k) std::copy_n(step.c[k], states, piece.c[k]);
  return true;
}

void Track::read(double t, double* y) const {
  const Piece* pieces = pieces_.get();
  if (!(t <= pieces[latest_].end && (latest_ == 0 || t > pieces[latest_].start))) {
    const auto before = [](const Piece& piece, double instant) { return piece.end < instant; };
    latest_ = static_cast<int>(std::lower_bound(pieces, pieces + count_ - 1, t, before) - pieces);
  }
  const Piece& piece = pieces[latest_];
  solver::evaluate<states>(piece.c, degree, (t - piece.end) / (piece.end - piece.start), y);
}

}  // namespace orbit
