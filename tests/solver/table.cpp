// The coefficients that the solver is compiled with.
#include "table.hpp"

#include <cstddef>
#include <cstdio>

#include "dormand_prince.hpp"

namespace {

// All rows of the table of DOP853, as lists of [stage, weight].
template <std::size_t n>
void print_row(const char* name, const solver::dormand_prince::Term (&row)[n]) {
  std::printf("\"%s\": [", name);
  for (std::size_t i = 0; i < n; ++i) std::printf("%s[%zu, %.17g]", i ? ", " : "", row[i].stage, row[i].weight);
  std::printf("], ");
}

}  // namespace

void print_table() {
  namespace t = solver::dormand_prince;
  std::printf("{");
  print_row("a_1", t::a_1), print_row("a_2", t::a_2), print_row("a_3", t::a_3), print_row("a_4", t::a_4);
  print_row("a_5", t::a_5), print_row("a_6", t::a_6), print_row("a_7", t::a_7), print_row("a_8", t::a_8);
  print_row("a_9", t::a_9), print_row("a_10", t::a_10), print_row("a_11", t::a_11), print_row("b", t::b);
  print_row("a_13", t::a_13), print_row("a_14", t::a_14), print_row("a_15", t::a_15);
  print_row("e_3", t::e_3), print_row("e_5", t::e_5);
  print_row("d_3", t::d_3), print_row("d_4", t::d_4), print_row("d_5", t::d_5), print_row("d_6", t::d_6);
  std::printf("\"stages\": 16}\n");
}
