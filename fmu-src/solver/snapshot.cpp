#include "solver.hpp"
namespace solver {
std::size_t Solver::history_size() const { return 0; }
void Solver::save_history(unsigned char*) const {}
bool Solver::restore_history(const Problem&, const unsigned char*, std::size_t) { return false; }
}
