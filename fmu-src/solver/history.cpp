// Snapshots: what an engine remembers, as numbers, each checked before it is used.
#include <limits>

#include "bytes.hpp"
#include "solver.hpp"

namespace solver {

// Fields are written only when they are read; a solver that is saved stays as it is.
void Solver::visit(support::Archive& archive) {
  archive("method").count(method_, 0, static_cast<int>(Method::runge_kutta));
  archive("outcome of the last step").count(pending_, 0, static_cast<int>(Outcome::failed));
  archive("event").count(event_, 0, std::numeric_limits<int>::max());
  archive("time known, s").number(known_until_);
  archive("time of the event, s").number(event_time_);
  archive("values of watched functions").numbers(values_, max_watched);
  archive("time of a stop, s").range(stop_time_, -archive.greatest, never);
  archive("counters");
  for (long long* count : counters_.all()) archive.tally(*count);
  archive("start of the step, s").number(step_.start);
  archive("end of the step, s").number(step_.end);
  archive("states at the ends of the step").numbers(step_.y_start, problem_.states);
  archive.numbers(step_.y_end, problem_.states);
  if (archive.reads() && !restored_fits()) archive.refuse();
  for (Engine* one : engines_)
    if (!archive.fault()) one->visit(archive, problem_, &step_, one == &engine());
}

void Solver::save_history(support::Archive& archive) const { const_cast<Solver&>(*this).visit(archive); }

bool Solver::restore_history(const Problem& problem, support::Archive& archive) {
  problem_ = problem;
  step_ = {};
  step_.degree = -1;
  runge_kutta_ = {};
  visit(archive);
  failure_ = pending_ == Outcome::failed ? "the solver had failed before the state was saved" : nullptr;
  if (archive.is_sound()) return true;
  failure_ = "the solver's history could not be restored";
  const double none[max_states] = {};
  step_.set_point(0, none, problem.states);  // reading it is harmless
  pending_ = Outcome::failed;
  return false;
}

// Times in order, and those that one outcome goes with; an event that is watched.
bool Solver::restored_fits() const {
  bool watched = false;
  for (int i = 0; i < problem_.watched_count; ++i) watched = watched || problem_.watched[i].event == event_;
  if (pending_ == Outcome::event && !watched) return false;
  if (!(step_.start <= known_until_ && known_until_ <= step_.end)) return false;
  if (pending_ == Outcome::failed) return step_.start == step_.end;
  return known_until_ == event_time_ || (pending_ == Outcome::stepped && known_until_ == step_.end);
}

}  // namespace solver
