// What acts on the wheel from an instant on: road and inputs; the mode of rolling, after Filippov; and whether the
// wheel grips or slides, after Coulomb. The mode is the branch of the law of rolling resistance that holds
// (WheelFriction): without a moment, to one side, held at omega_z = 0, or regularized. The parameter friction_law
// chooses the law.
//
// Results depend on the arguments alone. Functions that decide write contact and mode in `in_force`, and the slip in y.
//
//                     writes                          called
//   enforce           road, inputs, carrier's rates   at the start, at a step after something was set, for a reading
//   decide_contact    contact, mode, slip             by enforce, and where a slip ends
//   decide_mode       mode                            by decide_contact, at events of the spin, in model exchange
//   release           mode                            where resistance and brake cannot hold the wheel
//   begin_slide       contact, mode, slip             by decide_contact, and where the grip is lost
// Which observed events lie below zero, and with it whether the ground pulls, is written by InForce::set_below
// (in_force.hpp): at events, after a motion on an orbit, and where a saved state is read. Nothing here counts or logs:
// transitions.hpp does.
#pragma once

#include "constant.hpp"
#include "in_force.hpp"

namespace wheel {

// (demand, t, y) => in_force, y. From t on, what the caller has set is in force, and with it the contact and the mode
// that follow. In y the slip is written, and the rates that a jump of the carrier changes.
void enforce(const Setup& setup, const Demand& demand, double t, double* y, InForce& in_force);

// (y) => y of a wheel whose carrier has always turned at the rates asked for
void start_guide_rates(const Setup& setup, const Demand& demand, double* y);

// (t, y) => contact, mode, slip in y. A slip above the least goes on. Else the wheel rolls where it can; where it
// cannot, it begins to slide, unless it lifts off.
void decide_contact(const Setup& setup, double t, double* y, InForce& in_force);

// (t, y) => mode. At omega_z = 0 the exact law follows Filippov: the wheel is held where the
// moment that holds it is within s N + M_brake, else it rolls against that moment. A regularized law depends on whether
// omega_z lies in its layer.
void decide_mode(const Setup& setup, double t, const double* y, InForce& in_force);

// (scene, y) => the mode where a brake is in use, even if its capacity is zero
WheelFriction braked_mode(const Setup& setup, const WheelScene& scene, const double* y);

// (t, y) => mode of a wheel that resistance and brake can no longer hold
void release(const Setup& setup, double t, const double* y, InForce& in_force);

// (t, y without slip) => contact, mode, slip in y. The wheel starts to slide, in the direction in which Coulomb's law
// lets a slip grow and stay.
void begin_slide(const Setup& setup, double t, double* y, InForce& in_force);

// (scene, y of a wheel that slides) => direction in which a slip begins, rad. Where Coulomb's law gives none, an event
// that ends the run follows at once, or the ground begins to pull; then the slip begins along the forces.
double first_direction(const WheelScene& scene, const double* y);

// (t) => m/s, the slip at which a slide ends; it begins with twice as much. Below it the direction of the slip turns
// ever faster. It is a small part of the tolerance, and large enough for the digits of an instant.
double least_slip(const Setup& setup, double t);

// Whether the road limits the force on a rolling wheel. mu_max = 0 means no limit, but no friction if the wheel can
// slide.
inline bool is_limited(const Setup& setup, const Road& road) { return setup.can_slide() || road.mu_max > 0; }

// (t, y of a wheel that rolls) => N^2 - (lambda_t / mu_max)^2 over the weight squared; below zero too where the ground
// pulls.
double grip_left(const Setup& setup, const InForce& in_force, double t, const double* y);

// Whether two modes differ in kind, or in the side to which the wheel spins.
inline bool differ(const WheelFriction& a, const WheelFriction& b) { return a.kind != b.kind || a.sigma != b.sigma; }

// (scene, y) => the moment tau that would hold the wheel, N m, and the reserve s N + M_brake - |tau|, N m. It includes
// the rounding of both, so that a wheel stays held where rounding alone decides.
struct Hold {
  double tau, reserve;
};
Hold hold_at(const Setup& setup, WheelScene scene, const double* y);

// rad/s, half the width of the layer of a regularized law (Setup::has_layer).
CONSTANT(double, edge, 20, "omega_s", "1 - tanh(20) is below the last digit; from 19 on");
inline double layer_edge(const Setup& setup) { return edge * setup.omega_s; }

}  // namespace wheel
