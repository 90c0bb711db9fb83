// Forged states: a state of an instance, some of its words changed and its checksum made right again, brought to
// another instance. Whether it is refused, with one message, or taken: whatever follows ends soon and without harm.
#include <cstring>

#include "bytes.hpp"
#include "session.hpp"

namespace fuzz {
namespace {

// A header of whole words, then numbers of eight bytes: the same change is never made twice.
void change(Digest& bytes, Bytes& in) {
  const std::size_t words = bytes.size() / 8;
  for (unsigned k = 1 + in.below(3); k > 0; --k) {
    unsigned char word[8];
    auto* const place = bytes.data() + 8 * (in.word() % words);
    const double number = in.any();
    const std::int64_t whole = static_cast<std::int64_t>(in.byte()) - 3;
    const void* const sources[] = {&number, &whole, place, bytes.data() + 8 * (in.word() % words)};
    const unsigned kind = in.below(4);
    std::memcpy(word, sources[kind], 8);
    if (kind == 2) word[in.below(8)] ^= static_cast<unsigned char>(1u << in.below(8));
    std::memcpy(place, word, 8);
  }
  if (in.chance(1))
    bytes.erase(bytes.end() - 8L * in.below(words < 200 ? static_cast<unsigned>(words) : 200), bytes.end());
}

// A mark, the size, the checksum of what follows, and that.
Digest with_checksums(Digest bytes) {
  constexpr std::size_t header = 24;
  if (bytes.size() < header) return bytes;
  const auto* const first = reinterpret_cast<const unsigned char*>(bytes.data());
  const std::uint64_t words[] = {bytes.size(), support::checksum_of(first + header, bytes.size() - header)};
  std::memcpy(bytes.data() + 8, words, sizeof words);
  return bytes;
}

// All that reads, in whatever state the instance is.
void read_all(fmi2Component c) {
  const int first = 1;
  const unsigned knowns[] = {ref_F_X, ref_m};
  const double seed = 1;
  for (const Row& row : rows) {
    const unsigned v = row.reference;
    double real = 0;
    int whole = 0;
    fmi2GetReal(c, &v, 1, &real);
    fmi2GetInteger(c, &v, 1, &whole);
    fmi2GetRealOutputDerivatives(c, &v, 1, &first, &real);
    for (const unsigned& known : knowns) fmi2GetDirectionalDerivative(c, &v, 1, &known, 1, &seed, &real);
  }
}

void push(fmi2Component c, Bytes& in) {
  const unsigned input = any_of(Role::input, in.byte());
  const int order = 1 + static_cast<int>(in.below(3));
  const double value = in.factor() - 1, slope = in.factor() - 1;
  if (in.chance(8)) fmi2SetReal(c, &input, 1, &value);
  if (in.chance(8)) fmi2SetRealInputDerivatives(c, &input, 1, &order, &slope);
}

// In whatever mode the state was.
void go_on(fmi2Component c, fmi2Type kind, Bytes& in) {
  double t = 0;
  for (unsigned k = in.below(8); k > 0; --k) {
    push(c, in);
    if (kind == fmi2CoSimulation) {
      if (fmi2GetRealStatus(c, fmi2LastSuccessfulTime, &t) != fmi2OK) t = 0;
      fmi2DoStep(c, t, short_step(c) * in.factor(), fmi2True);
    } else if (fmi2EnterEventMode(c) == fmi2OK && decide(c) && fmi2EnterContinuousTimeMode(c) == fmi2OK) {
      move_freely(c, 0.01 * in.factor(), in);
    }
  }
}

}  // namespace

void bring_forged(fmi2Component origin, fmi2Component victim, fmi2Type kind, Bytes& in) {
  const Digest honest = digest(origin), before = digest(victim);
  expect(with_checksums(honest) == honest, "a state carries its own checksums");
  Digest forged = honest;
  change(forged, in);
  forged = with_checksums(forged);
  fmi2FMUstate state = nullptr;
  const auto is_reported = [said = log().messages](fmi2Status status) {
    return status == fmi2OK || (status == fmi2Error && (log().messages == said + 1 || !log().on));
  };
  const fmi2Status taken = fmi2DeSerializeFMUstate(victim, forged.data(), forged.size(), &state);
  expect(is_reported(taken), "bytes that are refused are reported in one message");
  expect(digest(victim) == before, "bytes that are only taken change nothing");
  if (taken == fmi2OK) {
    const fmi2Status restored = fmi2SetFMUstate(victim, state);
    trace("  %d\n", restored);
    expect(is_reported(restored), "a state that is refused is reported in one message");
    expect(fmi2FreeFMUstate(victim, &state) == fmi2OK, "a state can be freed");
  }
  read_all(victim);
  go_on(victim, kind, in);
  read_all(victim);
  expect(!digest(victim).empty(), "a state can always be taken");
  expect(fmi2Reset(victim) == fmi2OK, "reset succeeds");
  fmi2FreeInstance(victim);
}

void Session::forge_state() {
  Slot& other = slots_[now_ == slots_];
  const fmi2Component victim = other.component ? other.component : make_instance();
  other = {};
  bring_forged(now_->component, victim, fmi2CoSimulation, in_);
}

}  // namespace fuzz
