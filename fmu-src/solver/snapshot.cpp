// Snapshots: what an engine remembers, as numbers, each checked before it is used.
#include <algorithm>

#include "bytes.hpp"
#include "solver.hpp"

namespace solver {

// All but CVODE's own record.
template <class Archive>
void Solver::visit(Archive& archive) {
  constexpr double never = std::numeric_limits<double>::infinity();
  archive.count(method_, 0, static_cast<int>(Method::runge_kutta));
  archive.count(pending_, 0, static_cast<int>(Outcome::failed));
  archive.count(event_, 0, std::numeric_limits<int>::max());
  archive.number(known_until_), archive.number(event_time_), archive.numbers(values_, max_watched);
  archive.range(stop_time_, -Archive::greatest, never);
  for (long long* count :
       {&counters_.steps, &counters_.rhs, &counters_.jacobians, &counters_.roots, &counters_.restarts})
    archive.tally(*count);
  archive.number(step_.start), archive.number(step_.end);
  archive.numbers(step_.y_start, problem_.states), archive.numbers(step_.y_end, problem_.states);
  runge_kutta_.visit(archive, problem_.states);
  if (method_ != Method::runge_kutta) archive.count(cvode_.starts_anew(), 0, 2);
}

bool Solver::has_cvode_history() const { return method_ != Method::runge_kutta && step_.end > step_.start; }

// The visitors write what they are given only when they read; a solver that is saved stays as it is.
std::size_t Solver::history_size() const {
  support::Measure measure;
  auto& self = const_cast<Solver&>(*this);
  self.visit(measure);
  if (has_cvode_history()) self.cvode_.measure(measure);
  return measure.bytes;
}

void Solver::save_history(unsigned char* bytes) const {
  support::Writer writer(bytes);
  auto& self = const_cast<Solver&>(*this);
  self.visit(writer);
  if (has_cvode_history()) self.cvode_.save(writer);
}

bool Solver::restore_history(const Problem& problem, const unsigned char* bytes, std::size_t size) {
  support::Reader reader(bytes, size);
  problem_ = problem;
  failure_ = "it had failed before it was saved";
  step_ = {};
  step_.degree = -1;
  runge_kutta_ = {};
  visit(reader);
  if (!reader.fault && restored_fits() && restore_engine(reader) && reader.at == reader.end) return true;
  failure_ = "its history could not be restored";
  const double none[max_states] = {};
  step_.set_point(0, none, problem.states);  // reading it is harmless
  return pending_ = Outcome::failed, false;
}

// Times in order, and those that one outcome goes with; an event that is watched.
bool Solver::restored_fits() const {
  const Watched* watched = problem_.watched;
  const auto happened = [this](const Watched& w) { return w.event == event_; };
  if (pending_ == Outcome::event && std::none_of(watched, watched + problem_.watched_count, happened)) return false;
  if (!(step_.start <= known_until_ && known_until_ <= step_.end)) return false;
  if (pending_ == Outcome::failed) return step_.start == step_.end;
  return known_until_ == event_time_ || (pending_ == Outcome::stepped && known_until_ == step_.end);
}

bool Solver::restore_engine(support::Reader& reader) {
  if (method_ == Method::runge_kutta) return runge_kutta_.fits(problem_, &step_);
  if (has_cvode_history()) return cvode_.restore(problem_, method_, &step_, reader);
  double y[max_states];
  std::copy_n(step_.y_end, max_states, y);
  const int anew = cvode_.starts_anew();
  if (anew == 0 || !cvode_.start(problem_, method_, known_until_, y, &step_)) return false;
  cvode_.starts_anew() = anew;
  return true;
}

}  // namespace solver
