// Where sentences go.
#pragma once

namespace wheel {

enum class Topic { event, warning, error, discard };

struct Reporter {
  void* owner = nullptr;
  bool (*listens)(void* owner, Topic topic) = nullptr;  // null: nobody does
  void (*take)(void* owner, Topic topic, const char* sentence) = nullptr;

  // Whether a sentence is wanted: to find its numbers takes time.
  bool wants(Topic topic) const { return listens && listens(owner, topic); }
  // Printf-like.
  void tell(Topic topic, const char* format, ...) const;
};

}  // namespace wheel
