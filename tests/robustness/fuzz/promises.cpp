// Rollback, serialization, and their promise: the same bits after a restored state, here or in another instance.
#include "session.hpp"

namespace fuzz {

void Session::take_state() {
  Saved& saved = saved_[in_.below(3)];
  const fmi2Status status = call(anywhere, fmi2GetFMUstate, &saved.state);
  expect(status == fmi2OK && saved.state, "a state can always be taken");
  saved.model = now_->model;
}

void Session::restore_state() {
  const Saved& saved = saved_[in_.below(3)];
  const fmi2Status status = call(anywhere, fmi2SetFMUstate, saved.state);
  expect(status == (saved.state ? fmi2OK : fmi2Error), "a state that was taken can be restored");
  if (saved.state) now_->model = saved.model;
}

void Session::free_state() {
  fmi2FMUstate* const state = &saved_[in_.below(3)].state;
  expect(call(anywhere, fmi2FreeFMUstate, in_.chance(2) ? nullptr : state) == fmi2OK, "freeing a state succeeds");
}

void Session::repeat_step_after_rollback() {
  if (now_->model.state != step_complete) return;
  const Model before = now_->model;
  const double t = time_of(now_->component), h = drawn_step();
  const bool reads_between = in_.chance(8);
  fmi2FMUstate state = nullptr;
  expect(fmi2GetFMUstate(now_->component, &state) == fmi2OK, "a state can always be taken");
  step(*now_, t, h);
  const std::vector<double> first = readings(*now_);
  if (now_->model.state == step_complete) step(*now_, time_of(now_->component), h);
  expect(fmi2SetFMUstate(now_->component, state) == fmi2OK, "a state that was taken can be restored");
  now_->model = before;
  if (reads_between) readings(*now_);
  step(*now_, t, h);
  expect(same_bits(first, readings(*now_)), "the same bits follow after a rollback");
  fmi2FreeFMUstate(now_->component, &state);
}

void Session::repeat_step_in_new_instance() {
  if (now_->model.state != step_complete) return;
  const double t = time_of(now_->component), h = drawn_step();
  const Digest bytes = digest(now_->component);
  Slot other = {make_instance(), now_->model};
  fmi2FMUstate state = nullptr;
  expect(fmi2DeSerializeFMUstate(other.component, bytes.data(), bytes.size(), &state) == fmi2OK,
         "a serialized state is read");
  expect(fmi2SetFMUstate(other.component, state) == fmi2OK, "a state of another instance can be set");
  expect(fmi2FreeFMUstate(other.component, &state) == fmi2OK, "a state can be freed");
  expect(digest(other.component) == bytes, "a restored state serializes to the same bytes");
  expect(same_bits(readings(*now_), readings(other)), "a restored state reads the same bits");
  step(*now_, t, h);
  step(other, t, h);
  expect(same_bits(readings(*now_), readings(other)), "the same bits follow in another instance");
  fmi2FreeInstance(other.component);
}

// After a reset the instance is as new, whatever happened to it.
void Session::compare_reset_with_new() {
  reset();
  Slot other = {make_instance(), {}};
  expect(digest(now_->component) == digest(other.component), "a reset instance is as a new one");
  Slot* const old = now_;
  for (Slot* slot : {&other, old}) {
    now_ = slot;
    enter_initialization();
    exit_initialization();
    step(*now_, 0, 0.5);
  }
  expect(same_bits(readings(*old), readings(other)), "a reset instance runs as a new one");
  fmi2FreeInstance(other.component);
}

}  // namespace fuzz
