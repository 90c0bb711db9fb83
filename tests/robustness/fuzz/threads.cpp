// Sessions of the fuzzer in two threads, sixteen under way in each at a time, in random order: every status, message,
// reading and serialized byte is that of the same session alone. threads ROUNDS CORPUS: status 1 where one differs.
// For the thread sanitizer, for valgrind and, with no rounds, for the coverage of the inputs.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <future>
#include <memory>
#include <random>
#include <set>
#include <sstream>

#include "session.hpp"

namespace {

constexpr std::size_t at_once = 16;

struct Input {
  std::vector<std::uint8_t> bytes;
  std::uint64_t sum_alone = 0;

  std::unique_ptr<fuzz::Session> session() const { return std::make_unique<fuzz::Session>(bytes.data(), bytes.size()); }
};

// Inputs in hexadecimal, one a line, each played alone.
std::vector<Input> inputs_of(const char* path) {
  std::vector<Input> inputs;
  std::ifstream corpus(path);
  for (std::string line; std::getline(corpus, line);) {
    Input& input = inputs.emplace_back();
    for (std::size_t at = 0; at < line.size(); at += 2)
      input.bytes.push_back(static_cast<std::uint8_t>(std::stoul(line.substr(at, 2), nullptr, 16)));
    const auto alone = input.session();
    while (alone->go_on()) {
    }
    input.sum_alone = alone->seen().sum;
  }
  return inputs;
}

struct Played {
  unsigned long calls = 0;
  unsigned different = 0;
};

// Each input `rounds` times, in an order that the seed decides.
Played play(const std::vector<Input>& inputs, unsigned rounds, unsigned seed) {
  Played played;
  std::mt19937 dice(seed);
  std::vector<const Input*> waiting;
  for (const Input& input : inputs) waiting.insert(waiting.end(), rounds, &input);
  std::shuffle(waiting.begin(), waiting.end(), dice);
  std::vector<std::pair<const Input*, std::unique_ptr<fuzz::Session>>> under_way;
  while (!waiting.empty() || !under_way.empty()) {
    if (!waiting.empty() && under_way.size() < at_once) {
      under_way.emplace_back(waiting.back(), waiting.back()->session());
      waiting.pop_back();
    }
    const std::size_t at = dice() % under_way.size();
    const auto& [input, session] = under_way[at];
    if (session->go_on()) continue;
    played.calls += session->seen().calls;
    played.different += session->seen().sum != input->sum_alone;
    std::swap(under_way[at], under_way.back());
    under_way.pop_back();
  }
  return played;
}

}  // namespace

int main(int count, char** words) {
  if (count != 3) return 2;
  const std::vector<Input> inputs = inputs_of(words[2]);
  std::set<std::uint64_t> sums;
  for (const Input& input : inputs) sums.insert(input.sum_alone);
  const auto rounds = static_cast<unsigned>(std::strtoul(words[1], nullptr, 10));
  auto other = std::async(std::launch::async, play, std::cref(inputs), rounds, 1);
  const Played here = play(inputs, rounds, 2), there = other.get();
  const unsigned different = here.different + there.different;
  std::printf(
      "%zu sessions in 2 threads, %lu calls, %u with other bits than alone; %zu of %zu inputs have sums of their own\n",
      2 * rounds * inputs.size(), here.calls + there.calls, different, sums.size(), inputs.size());
  return inputs.empty() || different > 0 ||
         sums.size() < inputs.size() * 9 / 10;  // the partner: sessions that differ have other sums
}
