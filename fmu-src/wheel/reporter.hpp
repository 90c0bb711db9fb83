// Where messages go.
#pragma once

namespace wheel {

enum class Topic { event, warning, error, discard };

struct Reporter {
  void* owner = nullptr;
  bool (*listens)(void* owner, Topic topic) = nullptr;  // null: nobody does
  void (*take)(void* owner, Topic topic, const char* message) = nullptr;

  // Whether a message is wanted: formatting its numbers takes time.
  bool wants(Topic topic) const { return listens && listens(owner, topic); }
  // Printf-like.
  void log(Topic topic, const char* format, ...) const;
};

}  // namespace wheel
