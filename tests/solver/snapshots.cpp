// Snapshots of the solver alone.
#include "snapshots.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <vector>

#include "problems.hpp"

using solver::Outcome;
using solver::Solver;
using support::Archive;

namespace {

Case watched() {
  Case c = van_der_pol(3);
  c.each_step = [](double, const double* y) { return y[0] + 10; };
  return c;
}

std::vector<unsigned char> save(const Solver& s) {
  Archive counting = Archive::counting();
  s.save_history(counting);
  std::vector<unsigned char> bytes(counting.bytes());
  Archive writing = Archive::writing(bytes.data());
  s.save_history(writing);
  return bytes;
}

bool restore(Solver& s, Case& c, const std::vector<unsigned char>& bytes) {
  Archive reading = Archive::reading(bytes.data(), bytes.size());
  return s.restore_history(c.problem(), reading);
}

// Steps on; true while the other does the same to the bit.
bool same_steps(Solver& a, Solver& b, int steps) {
  for (int i = 0; i < steps; ++i) {
    const Outcome one = a.step(), other = b.step();
    const double t = 0.5 * (a.step_start() + a.known_until());
    double y[2], z[2];
    a.read(t, y), b.read(t, z);
    if (one != other || a.known_until() != b.known_until() || std::memcmp(y, z, sizeof y) != 0) return false;
    if (a.counters().rhs != b.counters().rhs || a.counters().roots != b.counters().roots) return false;
  }
  return true;
}

}  // namespace

void measure_snapshots(solver::Method method, int steps) {
  Case c = watched();
  Solver original, copy;
  original.start(c.problem(), method, 0, c.y.data());
  for (int i = 0; i < steps; ++i) original.step();
  const auto bytes = save(original);
  const bool restored = restore(copy, c, bytes);
  const bool again = restored && save(copy) == bytes;
  double y[2], z[2];
  const double t = original.step_start() + 0.3 * (original.known_until() - original.step_start());
  original.read(t, y), copy.read(t, z);
  const bool reads = std::memcmp(y, z, sizeof y) == 0;
  const bool same = restored && same_steps(original, copy, 200);
  // Back to the past, in a solver that has gone on.
  Solver once_more;
  const bool back = restore(once_more, c, bytes) && restore(copy, c, bytes) && same_steps(once_more, copy, 100);
  std::printf("{\"restored\": %d, \"again\": %d, \"reads\": %d, \"same\": %d, \"back\": %d, \"bytes\": %zu}\n",
              restored, again, reads, same, back, bytes.size());
}

void measure_forgeries(solver::Method method) {
  Case c = watched();
  Solver original;
  original.start(c.problem(), method, 0, c.y.data());
  for (int i = 0; i < 60; ++i) original.step();
  const auto bytes = save(original);
  std::vector<std::uint64_t> words = {0, 1, 2, 13, 1u << 20, ~0ull, 1ull << 63, 1ull << 62};
  for (double x : {-1.0, 1e-300, 1e300, 1e-3, double{INFINITY}, -double{INFINITY}, double{NAN}}) {
    words.push_back(0);
    std::memcpy(&words.back(), &x, sizeof x);
  }
  int tried = 0, taken = 0, stepped = 0, not_numbers = 0, stained = 0;
  for (std::size_t at = 0; at < bytes.size(); at += 8)
    for (const std::uint64_t word : words) {
      auto forged = bytes;
      std::memcpy(forged.data() + at, &word, sizeof word);
      if (forged == bytes) continue;
      ++tried;
      Solver s;
      if (!restore(s, c, forged)) {
        s.start(c.problem(), method, 0, c.y.data());
        Solver fresh;
        fresh.start(c.problem(), method, 0, c.y.data());
        stained += !same_steps(s, fresh, 3);
        continue;
      }
      ++taken;
      double value;
      std::memcpy(&value, &word, sizeof value);
      not_numbers += std::isnan(value);
      for (int i = 0; i < 20; ++i) stepped += s.step() == Outcome::stepped;
      double y[2];
      s.read(s.known_until(), y);
    }
  auto halfway = bytes;  // the step that is known to half of it alone
  constexpr std::size_t time_known = 3 * 8;
  const double half = 0.5 * (original.step_start() + original.known_until());
  std::memcpy(halfway.data() + time_known, &half, sizeof half);
  Solver s;
  const bool half_known = restore(s, c, halfway);
  int cut = 0;
  for (std::size_t size = 0; size < bytes.size(); size += 8)
    cut += restore(s, c, std::vector<unsigned char>(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)));
  std::printf(
      "{\"tried\": %d, \"taken\": %d, \"not_numbers\": %d, \"stepped\": %d, \"cut\": %d, "
      "\"stained\": %d, \"half_known\": %d}\n",
      tried, taken, not_numbers, stepped, cut, stained, half_known);
}
