// The values of arguments.
#include "arguments.hpp"

namespace fuzz {
namespace {

// Sizes that matter: the start values of the parameters as modelDescription.xml has them, and what moves a wheel.
double usual_size(unsigned reference) {
  const Row& row = row_of(reference);
  return row.role == Role::input ? 10 : row.start == 0 ? 0.1 : row.start;
}

struct Range {
  unsigned first, count;
};
constexpr Range ranges[] = {{0, ref_count}, {ref_first_input, input_count}, {ref_first_output, output_count}};
constexpr unsigned choices[] = {ref_formulation, ref_friction_law, ref_method, ref_keep_contact};

}  // namespace

double value_for(unsigned reference, Bytes& in) {
  if (reference >= ref_first_output || in.chance(2)) {
    // Extreme loads are limited: CVODE would honestly follow them through the million steps that a call may take.
    const double value = in.any();
    return reference >= ref_first_input && std::isfinite(value) ? std::remainder(value, 1e4) : value;
  }
  if (in.chance(2)) return 0;
  const double value = usual_size(reference) * in.factor();
  return in.chance(4) ? -value : value;
}

void Arguments::fill(std::vector<unsigned>& references) {
  const unsigned kind = in_.below(4);
  for (std::size_t k = 0; k < count_; ++k) {
    const unsigned choice = in_.byte();
    references[k] = kind == 3 ? choices[choice % 4] : ranges[kind].first + choice % ranges[kind].count;
    if (choice >= 250) references[k] = choice * 0x01010101u;
    trace("  variable %u\n", references[k]);
  }
}

void Arguments::fill(std::vector<double>& values) {
  for (std::size_t k = 0; k < count_; ++k) {
    values[k] = value_for(std::get<Arrays<unsigned>>(arrays_).back()[k], in_);
    trace("  %.17g\n", values[k]);
  }
}

void Arguments::fill(std::vector<int>& values) {
  for (std::size_t k = 0; k < count_; ++k) {
    values[k] = static_cast<int>(in_.chance(14) ? in_.below(5) : in_.byte() * 0x01010101u);
    trace("  %d\n", values[k]);
  }
}

}  // namespace fuzz
