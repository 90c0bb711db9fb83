// One row per function, one bit per state. Whether a variable may be set depends on the variable too: see values.cpp.
#include "legality.hpp"

namespace fmi {
namespace {

constexpr unsigned bit(State state) { return 1u << static_cast<unsigned>(state); }

constexpr unsigned I = bit(State::instantiated), M = bit(State::initialization), C = bit(State::step_complete),
                   F = bit(State::step_failed), T = bit(State::terminated), X = bit(State::error);

struct Rule {
  Function function;
  unsigned states;
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

bool is_legal(Function function, State state) { return rules[static_cast<unsigned>(function)].states & bit(state); }

const char* name_of(State state) {
  constexpr const char* names[] = {"instantiated", "initialization mode", "step complete",
                                   "step failed",  "terminated",          "error"};
  return names[static_cast<unsigned>(state)];
}

}  // namespace fmi
