// A message as one text.
#include "reporter.hpp"

#include <cstdarg>

namespace wheel {

void Reporter::print(Topic topic, const char* format, ...) const {
  char message[longest];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  take(owner, topic, message);
}

}  // namespace wheel
