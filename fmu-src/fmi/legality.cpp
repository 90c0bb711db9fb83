// One row per function, one bit per phase. Whether a variable may be set depends on the variable too: see values.cpp.
#include "legality.hpp"

namespace fmi {
namespace {

using wheel::Phase;

template <class... Phases>
constexpr unsigned bits(Phases... phases) {
  return ((1u << static_cast<unsigned>(phases)) | ...);
}

// The call states.
constexpr unsigned I = bits(Phase::created), M = bits(Phase::initializing, Phase::faulty, Phase::initial),
                   C = bits(Phase::at_start, Phase::stepping, Phase::unfolded),
                   F = bits(Phase::fell_flat, Phase::lifted_off), T = bits(Phase::closed, Phase::closed_after_end),
                   X = bits(Phase::failed, Phase::without_start);
static_assert((I | M | C | F | T | X) + 1 == bits(Phase::count) && (I ^ M ^ C ^ F ^ T ^ X) == (I | M | C | F | T | X));

struct Rule {
  Function function;
  unsigned phases;
};

constexpr Rule rules[] = {
    {Function::set_debug_logging, I | M | C | F | T | X},
    {Function::setup_experiment, I},
    {Function::enter_initialization, I},
    {Function::exit_initialization, M},
    {Function::terminate, C | F},
    {Function::reset, I | M | C | F | T | X},
    {Function::get_values, M | C | F | T | X},
    {Function::set_values, I | M | C},
    {Function::fmu_state, I | M | C | F | T | X},
    {Function::set_fmu_state, I | M | C | F | T | X},
    {Function::free_fmu_state, I | M | C | F | T | X},
    {Function::directional_derivative, M | C | F | T | X},
    {Function::set_input_derivatives, I | M | C},
    {Function::get_output_derivatives, C | F | T | X},
    {Function::do_step, C},
    {Function::cancel_step, 0},
    {Function::get_status, C | F | T},
    {Function::model_exchange, I | M | C | F | T | X},  // refused with a sentence of their own
};

constexpr bool in_order() {
  unsigned row = 0;
  for (const Rule& rule : rules)
    if (static_cast<unsigned>(rule.function) != row++) return false;
  return row == static_cast<unsigned>(Function::count);
}
static_assert(in_order());

}  // namespace

bool is_legal(Function function, Phase phase) { return rules[static_cast<unsigned>(function)].phases & bits(phase); }

const char* state_of(Phase phase) {
  constexpr struct {
    unsigned phases;
    const char* name;
  } states[] = {{I, "instantiated"}, {M, "initialization mode"}, {C, "step complete"},
                {F, "step failed"},  {T, "terminated"},          {X, "error"}};
  const auto* state = states;
  while (!(state->phases & bits(phase))) ++state;
  return state->name;
}

}  // namespace fmi
