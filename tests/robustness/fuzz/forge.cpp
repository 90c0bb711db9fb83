// Forged states: a state of a wheel on its way, some of its words changed and its checksums made right again, brought
// to another instance. It is refused with a sentence and the instance is as it was, or it is taken and whatever follows
// ends soon and without harm.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "bytes.hpp"
#include "choices.hpp"
#include "session.hpp"

namespace fuzz {
namespace {

// Every formulation, law and method of either kind; with and without friction, general inertia, inputs that vary.
void start(fmi2Component c, Bytes& in) {
  const unsigned choices[] = {ref_formulation, ref_friction_law, ref_method};
  const int picked[] = {1 + static_cast<int>(in.below(3)), 1 + static_cast<int>(in.below(2)),
                        1 + static_cast<int>(in.below(4))};
  const unsigned reals[] = {ref_s, ref_J_x, ref_M_3, ref_M_brake}, keep = ref_keep_contact;
  const double values[] = {in.chance(8) ? 0.03 : 0.0, in.chance(8) ? 0.9 : 1.0, in.chance(4) ? 0.2 : 0.0,
                           in.chance(4) ? 0.1 : 0.0};
  const int kept = in.chance(8);
  fmi2SetInteger(c, choices, 3, picked);
  fmi2SetReal(c, reals, 4, values);
  fmi2SetBoolean(c, &keep, 1, &kept);
  if (in.chance(1)) return;
  fmi2EnterInitializationMode(c);
  if (!in.chance(1)) fmi2ExitInitializationMode(c);
}

void push(fmi2Component c, Bytes& in) {
  const unsigned input = ref_first_input + in.below(input_count);
  const int order = 1 + static_cast<int>(in.below(3));
  const double value = in.factor() - 1, slope = in.factor() - 1;
  if (in.chance(8)) fmi2SetReal(c, &input, 1, &value);
  if (in.chance(8)) fmi2SetRealInputDerivatives(c, &input, 1, &order, &slope);
}

double now(fmi2Component c) {
  double t = 0;
  return fmi2GetRealStatus(c, fmi2LastSuccessfulTime, &t) == fmi2OK ? t : 0;
}

// Model exchange: modes are entered and left, and Euler's step is taken, whatever the instance answers.
void exchange(fmi2Component c, Bytes& in, double& t) {
  constexpr std::size_t states = 8, indicators = 4;
  double x[states], rates[states], z[indicators];
  fmi2EventInfo info = {};
  fmi2Boolean wanted = fmi2False, ends = fmi2False;
  if (in.chance(4)) fmi2EnterEventMode(c);
  if (in.chance(12) && fmi2NewDiscreteStates(c, &info) == fmi2OK)
    expect(!info.newDiscreteStatesNeeded, "one pass is enough");
  if (in.chance(12)) fmi2EnterContinuousTimeMode(c);
  if (fmi2GetDerivatives(c, rates, states) != fmi2OK) return;
  expect(std::all_of(rates, rates + states, [](double rate) { return std::isfinite(rate); }), "derivatives are finite");
  expect(fmi2GetContinuousStates(c, x, states) == fmi2OK, "states can be read where derivatives can");
  const double h = 0.01 * in.factor();
  for (std::size_t i = 0; i < states; ++i) x[i] += h * rates[i];
  fmi2SetTime(c, t += h);
  fmi2SetContinuousStates(c, x, states);
  fmi2GetEventIndicators(c, z, indicators);
  fmi2GetNominalsOfContinuousStates(c, x, states);
  fmi2CompletedIntegratorStep(c, fmi2True, &wanted, &ends);
}

void step(fmi2Component c, Bytes& in, unsigned most, fmi2Type kind) {
  double t = 0;
  for (unsigned k = in.below(most); k > 0; --k) {
    if (in.chance(4)) push(c, in);
    if (kind == fmi2ModelExchange)
      exchange(c, in, t);
    else
      fmi2DoStep(c, now(c), short_step(c) * in.factor(), fmi2True);
  }
}

// A header of whole words, then numbers of eight bytes: the same change is never made twice.
void forge(Digest& bytes, Bytes& in) {
  const std::size_t words = bytes.size() / 8;
  for (unsigned k = 1 + in.below(3); k > 0; --k) {
    unsigned char word[8];
    auto* const place = bytes.data() + 8 * ((in.byte() << 8 | in.byte()) % words);
    const double number = in.any();
    const std::int64_t whole = static_cast<std::int64_t>(in.byte()) - 3;
    std::memcpy(word, place, 8);
    switch (in.below(4)) {
      case 0:
        std::memcpy(word, &number, 8);
        break;
      case 1:
        std::memcpy(word, &whole, 8);
        break;
      case 2:
        word[in.below(8)] ^= static_cast<unsigned char>(1u << in.below(8));
        break;
      default:
        std::memcpy(word, bytes.data() + 8 * ((in.byte() << 8 | in.byte()) % words), 8);
    }
    std::memcpy(place, word, 8);
  }
  if (in.chance(1)) bytes.resize(bytes.size() - 8 * in.below(static_cast<unsigned>(std::min<std::size_t>(words, 200))));
}

// A mark, the size, the checksum of what follows, and that.
void sign(Digest& bytes) {
  constexpr std::size_t header = 24;
  if (bytes.size() < header) return;
  const std::uint64_t words[] = {
      bytes.size(),
      support::checksum_of(reinterpret_cast<const unsigned char*>(bytes.data()) + header, bytes.size() - header)};
  std::memcpy(bytes.data() + 8, words, sizeof words);
}

// All that reads, in whatever state the instance is.
void read_all(fmi2Component c) {
  const int first = 1;
  for (unsigned v = 0; v < ref_count; ++v) {
    double real = 0;
    int whole = 0;
    const unsigned force = ref_F_X, mass = ref_m;
    const double seed = 1;
    fmi2GetReal(c, &v, 1, &real);
    fmi2GetInteger(c, &v, 1, &whole);
    fmi2GetRealOutputDerivatives(c, &v, 1, &first, &real);
    fmi2GetDirectionalDerivative(c, &v, 1, &force, 1, &seed, &real);
    fmi2GetDirectionalDerivative(c, &v, 1, &mass, 1, &seed, &real);
  }
}

void go_on(fmi2Component c, Bytes& in, fmi2Type kind) {
  read_all(c);
  step(c, in, 6, kind);
  read_all(c);
  expect(!digest(c).empty(), "a state can always be taken");
  push(c, in);
  step(c, in, 6, kind);
  expect(fmi2Reset(c) == fmi2OK, "reset succeeds");
}

}  // namespace

void play_forged(Bytes& in, fmi2Type kind) {
  Log log;
  use(log);
  const fmi2Component origin = make_instance(kind), victim = make_instance(kind);
  start(origin, in);
  step(origin, in, 20, kind);
  start(victim, in);
  step(victim, in, 4, kind);
  Digest forged = digest(origin);
  const Digest before = digest(victim), honest = forged;
  sign(forged);
  expect(forged == honest, "a state carries its own checksums");
  forge(forged, in);
  sign(forged);
  fmi2FMUstate state = nullptr;
  log.messages = 0;
  const fmi2Status status = fmi2DeSerializeFMUstate(victim, forged.data(), forged.size(), &state);
  trace("%d\n", status);
  expect(status == fmi2OK || (status == fmi2Error && log.messages == 1), "a refused state is told in one sentence");
  expect(digest(victim) == before, "bytes that are only read change nothing");
  if (status == fmi2OK) {
    expect(fmi2SetFMUstate(victim, state) == fmi2OK, "a state that was taken can be restored");
    expect(fmi2FreeFMUstate(victim, &state) == fmi2OK, "a state can be freed");
  }
  go_on(victim, in, kind);
  fmi2FreeInstance(origin);
  fmi2FreeInstance(victim);
}

}  // namespace fuzz
