// A value that counts its changes, so that what was made of it can be compared with it.
#pragma once

namespace wheel {

template <class Value>
class Versioned {
 public:
  explicit Versioned(const Value& value = Value()) : value_(value) {}
  const Value& operator*() const { return value_; }
  const Value* operator->() const { return &value_; }
  // To be changed; whatever was made of the value before is out of date.
  Value& change() {
    ++version_;
    return value_;
  }
  long long version() const { return version_; }

 private:
  Value value_;
  long long version_ = 0;
};

}  // namespace wheel
