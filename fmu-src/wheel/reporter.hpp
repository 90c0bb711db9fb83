// Where messages go.
#pragma once

namespace wheel {

enum class Topic { event, warning, error, discard };

struct Reporter {
  static constexpr int longest = 512;  // message, with the zero at its end

  const void* owner = nullptr;
  bool (*listens)(const void* owner, Topic topic) = nullptr;  // null: nobody does
  void (*take)(const void* owner, Topic topic, const char* message) = nullptr;

  // Whether a message is wanted: formatting its numbers takes time.
  bool wants(Topic topic) const { return listens && listens(owner, topic); }
  // Printf-like.
  void log(Topic topic, const char* format, ...) const;
};

}  // namespace wheel
