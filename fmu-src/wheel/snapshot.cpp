// The complete state as portable bytes: header (mark, version, size, checksum), then numbers of 8 bytes each.
#include <cstring>

#include "archive.hpp"
#include "simulation.hpp"

namespace wheel {
namespace {

constexpr std::uint64_t mark = 0x3330554d46484557;  // "WEHFMU03"; a change of the layout counts the last digits up

struct Header {
  std::uint64_t mark, size, checksum;
};

}  // namespace

// What the parameters do not determine: the method neither, since `s` may have changed after it was chosen. The archive
// passes through `this`, reading or writing it.
template <class Archive>
void Simulation::visit(Archive& archive, Moment& moment) {
  integrator::many(archive, stored_, stored_count);
  integrator::all(archive, start_time_, tolerance_, touched_, lifted_, lowest_force_, method_, scene_.wheel.s);
  integrator::all(archive, scene_.friction.kind, scene_.friction.sigma, scene_.friction.omega_s);
  inputs_.visit(archive);
  integrator::all(archive, moment.prepared, moment.started, moment.t, moment.events);
  integrator::many(archive, moment.y, WHEEL_MAX_STATES);
}

Simulation::Moment Simulation::moment_now() {
  Moment moment = {};
  moment.prepared = formulation_ != nullptr;
  moment.started = solver_ != nullptr;
  moment.t = now_.time();
  moment.events = now_.events;
  if (formulation_) std::memcpy(moment.y, now_.state(), sizeof(double) * formulation_->states);
  return moment;
}

std::size_t Simulation::state_size() {
  integrator::Measure measure;
  Moment moment = {};
  visit(measure, moment);
  return sizeof(Header) + measure.bytes + (solver_ ? solver_->history_size() : 0);
}

void Simulation::save_state(unsigned char* bytes) {
  Moment moment = moment_now();
  integrator::Writer writer{bytes + sizeof(Header)};
  visit(writer, moment);
  if (solver_) solver_->save_history(writer.at);
  const std::size_t size = state_size();
  const Header header = {mark, size, integrator::checksum_of(bytes + sizeof(Header), size - sizeof(Header))};
  std::memcpy(bytes, &header, sizeof header);
}

bool Simulation::is_state(const unsigned char* bytes, std::size_t size) {
  Header header;
  if (size < sizeof header) return false;
  std::memcpy(&header, bytes, sizeof header);
  return header.mark == mark && header.size == size &&
         header.checksum == integrator::checksum_of(bytes + sizeof header, size - sizeof header);
}

bool Simulation::load_state(const unsigned char* bytes) {
  integrator::Reader reader{bytes + sizeof(Header)};
  Moment moment;
  visit(reader, moment);
  if (!moment.started) solver_ = nullptr;
  const WheelFriction friction = scene_.friction;
  const double s_in_force = scene_.wheel.s, force = lowest_force_;
  const Inputs inputs = inputs_;
  const bool touched = touched_;
  const integrator::Method method = method_;
  // Without a start: none yet, or parameters made faulty since.
  if (!moment.prepared || !prepare(false)) {
    formulation_ = nullptr;
    now_ = Reading();
    return !moment.started;
  }
  method_ = method;
  if (moment.started && !start()) return false;
  scene_.friction = friction;
  scene_.wheel.s = s_in_force;
  inputs_ = inputs;
  touched_ = touched;
  inputs_.load_at(moment.t, &scene_);
  now_.events = moment.events;
  now_.set_state(moment.t, moment.y);
  if (moment.started && !solver_->restore_history(reader.at)) return false;
  lowest_force_ = force;
  return true;
}

}  // namespace wheel
