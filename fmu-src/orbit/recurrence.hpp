// An event that recurs on an orbit: the fall of a function that rises at the next crossing and falls again at the
// third, as N does. Its instants are known up to T2 and repeat with the period from there on. Times in s.
#pragma once

namespace orbit {

class Recurrence {
 public:
  // The next crossing of zero, a fall first; false if it is one too many.
  bool take(double t);
  // All crossings up to T2 and a little further are taken: from here on the later ones follow from the turning points.
  void repeat(double T1, double T2);

  // How many falls there are up to t, and when the number n is, counted from 0 (n below falls_until of some t). A start
  // below zero counts. The cost does not depend on t or n.
  long long falls_until(double t) const;
  double fall(long long n) const;

 private:
  static constexpr int most_crossings = 16;

  double T2_ = 0, period_ = 0;
  int falls_ = 0, rises_ = 0, later_falls_ = 0;  // up to T2; later: in the first period from there on, behind the falls
  double fall_[3 * most_crossings] = {}, rise_[most_crossings] = {};
};

}  // namespace orbit
