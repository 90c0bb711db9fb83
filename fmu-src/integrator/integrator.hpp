// One initial-value problem y' = f(t, y) and its CVODE solver: steps, dense output, events, endings, snapshots.
//
// Knows no wheel and no FMI. Time is the owner's own clock (s); the choice of steps never sees the times at which the
// owner asks for results, so the communication grid cannot change a bit of the solution.
#pragma once

#include <cstddef>

namespace integrator {

inline constexpr int max_states = 12;

enum class Method { adams, bdf };

// reached: the solution is known up to the time asked for;  event: `event` fell to zero at event_time();
// ended: `boundary` fell to zero at event_time();           failed: see failure().
enum class Outcome { reached, event, ended, failed };

// What the owner provides. `owner` is handed back to each function.
struct System {
  int states;         // 8 or 12
  int closed_states;  // even; the rates of the first closed_states states know these alone, the rest are quadratures
  Method method;
  void* owner;
  // The first `wanted` entries (states or closed_states) of y_dot = f(t, y); false where they are not finite: the
  // solver then tries a smaller step.
  bool (*derivative)(void* owner, double t, const double* y, double* y_dot, int wanted);
  // J[i + states * j] = d f_i / d y_j; asked for by bdf only.
  void (*jacobian)(void* owner, double t, const double* y, double* J);
  // Error weights: a step is accepted where the root mean square of weight times local error is below one.
  void (*weights)(void* owner, const double* y, double* weights);
  // Positive until the event; null: no root function is installed.
  double (*event)(void* owner, double t, const double* y);
  // Cheap test after each step, true where the boundary may be near; only then is `boundary` evaluated (> 0 inside).
  bool (*near_boundary)(void* owner, const double* y);
  double (*boundary)(void* owner, double t, const double* y);
  double longest_step;  // s, > 0: an unstable rest shows no error until it is too late
};

struct Counters {
  long long steps, rhs, jacobians, roots, restarts;
};

// Memory for one solver of any System. There is no other: a solver allocates nothing.
inline constexpr std::size_t room_size = 10 * 1024;
struct alignas(16) Room {
  unsigned char bytes[room_size];
};

class Integrator {
 public:
  // Made in `room`, and gone with it or with the next solver made there; there is nothing to free. Null if the room is
  // too small for SUNDIALS (tests/robustness/test_allocations.py has what is left of it).
  static Integrator* create(const System& system, Room& room);

  // Starts anew from y at time t; history is dropped, counters go on. event_armed: whether a root function is watched.
  bool restart(double t, const double* y, bool event_armed);

  // The steps that the calls of `advance` from here on may take together.
  void allow_steps(long long most);

  // Steps until the solution is known at t or something stops it. After `event` the owner restarts from event_time().
  Outcome advance(double t);

  // No step goes past t until then: what holds beyond is not known yet. t > known_until().
  void stop_before(double t);
  // A stop time left over from an event found exactly there would lie behind the restart: CVODE refuses that.
  void stop_nowhere();

  // Whether a jump of the right-hand side at known_until() is more than the error a step may make.
  bool notices(const double* y_dot_before, const double* y_dot_after) const;

  // y(t) for t between the start of the last step and known_until(); outside, the nearest of the two.
  void read(double t, double* y) const;

  double known_until() const;
  double event_time() const;
  const char* failure() const;
  const Counters& counters() const;

  // The complete history as numbers of 8 bytes; restored into a solver of the same System it goes on with the same
  // bits.
  std::size_t history_size() const;
  void save_history(unsigned char* bytes) const;
  bool restore_history(const unsigned char* bytes);

  struct Implementation;

 private:
  friend bool take_step(Integrator& solution);
  explicit Integrator(Implementation* i) : self(i) {}
  Implementation* self;
};

}  // namespace integrator
