// One row per function, one bit per phase. Whether a variable may be set depends on the variable too: see values.cpp.
#include "legality.hpp"

#include <algorithm>
#include <iterator>

namespace fmi {
namespace {

using wheel::Phase;

template <class... Phases>
constexpr unsigned bits(Phases... phases) {
  return ((1u << static_cast<unsigned>(phases)) | ...);
}

// The call states.
constexpr unsigned I = bits(Phase::created), M = bits(Phase::initializing, Phase::faulty, Phase::initial),
                   C = bits(Phase::at_start, Phase::stepping, Phase::unfolded), E = bits(Phase::event_mode),
                   N = bits(Phase::continuous_time), F = bits(Phase::ended), T = bits(Phase::closed),
                   X = bits(Phase::failed, Phase::without_start);
constexpr unsigned all = I | M | C | E | N | F | T | X;
static_assert(all + 1 == bits(Phase::count) && (I ^ M ^ C ^ E ^ N ^ F ^ T ^ X) == all);

enum Kinds { both, of_co_simulation, of_model_exchange };

struct Rule {
  Function function;
  unsigned phases;
  Kinds kinds = both;
};

constexpr Rule rules[] = {
    {Function::set_debug_logging, all},
    {Function::setup_experiment, I},
    {Function::enter_initialization, I},
    {Function::exit_initialization, M},
    {Function::terminate, C | E | N | F},
    {Function::reset, all},
    {Function::get_values, M | C | E | N | F | T | X},
    {Function::set_values, I | M | C | E | N},
    {Function::fmu_state, all},
    {Function::set_fmu_state, all},
    {Function::free_fmu_state, all},
    {Function::directional_derivative, M | C | E | N | F | T | X},
    {Function::set_input_derivatives, I | M | C, of_co_simulation},
    {Function::get_output_derivatives, C | F | T | X, of_co_simulation},
    {Function::do_step, C, of_co_simulation},
    {Function::cancel_step, 0, of_co_simulation},
    {Function::get_status, C | F | T, of_co_simulation},
    {Function::enter_event_mode, N, of_model_exchange},
    {Function::new_discrete_states, E, of_model_exchange},
    {Function::enter_continuous_time, E | F, of_model_exchange},
    {Function::completed_step, N, of_model_exchange},
    {Function::set_time, E | N, of_model_exchange},
    {Function::set_states, N, of_model_exchange},
    {Function::get_states, M | E | N | F | T | X, of_model_exchange},
};

constexpr auto out_of_order = [](const Rule& a, const Rule& b) { return a.function >= b.function; };
static_assert(std::adjacent_find(std::begin(rules), std::end(rules), out_of_order) == std::end(rules));
static_assert(std::size(rules) == static_cast<std::size_t>(Function::count));

}  // namespace

bool is_of_kind(Function function, wheel::Kind kind) {
  const Kinds own = kind == wheel::Kind::co_simulation ? of_co_simulation : of_model_exchange;
  const Kinds kinds = rules[static_cast<unsigned>(function)].kinds;
  return kinds == both || kinds == own;
}

bool is_legal(Function function, wheel::Kind kind, Phase phase) {
  return is_of_kind(function, kind) && rules[static_cast<unsigned>(function)].phases & bits(phase);
}

const char* state_of(Phase phase) {
  constexpr struct {
    unsigned phases;
    const char* name;
  } states[] = {{I, "instantiated"},         {M, "initialization mode"}, {C, "step complete"}, {E, "event mode"},
                {N, "continuous-time mode"}, {F, "step failed"},         {T, "terminated"},    {X, "error"}};
  const auto* state = states;
  while (!(state->phases & bits(phase))) ++state;
  return state->name;
}

}  // namespace fmi
