// Snapshots: the solver's history as plain numbers, so that a restored solution goes on with the same bits.
//
// CVODE has no call for this. Its own memory record (private header of the pinned source, 7.1.1) is read and written
// field by field: the Nordsieck array, the step and order selection, the root search and, for BDF, the factorised
// Newton matrix. What CVODE computes anew at the start of each step (error weights, work vectors) is left out.
#include <algorithm>
#include <cstring>

#include "archive.hpp"
#include "cvode_impl.h"
#include "cvode_ls_impl.h"
#include "implementation.hpp"
#include "start.hpp"
#include "state_vector.hpp"
#include "sunlinsol/sunlinsol_dense.h"
#include "sunmatrix/sunmatrix_dense.h"
#include "sunnonlinsol/sunnonlinsol_newton.h"

namespace integrator {
namespace {

template <class Archive>
void visit_progress(Archive& archive, Progress& p) {
  all(archive, p.armed, p.pending, p.step_start, p.known_until, p.event_time, p.last_event_value, p.start_size);
  all(archive, p.trend.error, p.trend.size, p.trend.order);
  all(archive, p.counters.steps, p.counters.rhs, p.counters.jacobians, p.counters.roots, p.counters.restarts);
}

template <class Archive>
void visit_steps(Archive& archive, CVodeMemRec& m) {
  all(archive, m.cv_q, m.cv_qprime, m.cv_next_q, m.cv_qwait, m.cv_L, m.cv_qu, m.cv_indx_acor);
  all(archive, m.cv_h, m.cv_hprime, m.cv_next_h, m.cv_eta, m.cv_hscale, m.cv_tn, m.cv_tretlast, m.cv_hu, m.cv_h0u,
      m.cv_hin);
  many(archive, m.cv_tau, L_MAX + 1);
  many(archive, m.cv_tq, NUM_TESTS + 1);
  many(archive, m.cv_l, L_MAX);
  all(archive, m.cv_saved_tq5, m.cv_tolsf, m.cv_etamax);
  all(archive, m.cv_etaqm1, m.cv_etaq, m.cv_etaqp1, m.cv_rl1, m.cv_gamma, m.cv_gammap, m.cv_gamrat);
  all(archive, m.cv_nst, m.cv_nfe, m.cv_ncfn, m.cv_nni, m.cv_nnf, m.cv_netf, m.cv_nsetups, m.cv_nstlp, m.cv_nscon);
}

template <class Archive>
void visit_corrector(Archive& archive, CVodeMemRec& m) {
  all(archive, m.cv_crate, m.cv_delp, m.cv_acnrm, m.cv_acnrmcur, m.convfail, m.cv_jcur);
}

// All but the first two are what the last step of CVODE left; its first step after a restart sets them anew.
template <class Archive>
void visit_roots(Archive& archive, CVodeMemRec& m) {
  all(archive, m.cv_irfnd, m.cv_nge);
  if (m.cv_nst == 0) return;
  all(archive, m.cv_tlo, m.cv_thi, m.cv_trout, m.cv_ttol, m.cv_toutc, m.cv_taskc);
  all(archive, m.cv_glo[0], m.cv_ghi[0], m.cv_grout[0], m.cv_iroots[0], m.cv_gactive[0]);
}

template <class Archive>
void visit_newton(Archive& archive, Integrator::Implementation& self, CVodeMemRec& m) {
  auto& interface = *static_cast<CVLsMem>(m.cv_lmem);
  auto& newton = *static_cast<SUNNonlinearSolverContent_Newton>(m.NLS->content);
  auto& dense = *static_cast<SUNLinearSolverContent_Dense>(self.linear->content);
  const int n = self.system.states;
  all(archive, interface.jbad, interface.nje, interface.nstlj, interface.tnlj, newton.jcur, dense.last_flag);
  many(archive, SUNDenseMatrix_Data(interface.A), n * n);
  many(archive, SUNDenseMatrix_Data(interface.savedJ), n * n);
  for (int i = 0; i < n; ++i) archive(dense.pivots[i]);
}

template <class Archive>
void visit(Archive& archive, Integrator::Implementation& self) {
  auto& m = *static_cast<CVodeMem>(self.cvode);
  visit_progress(archive, self.progress);
  many(archive, data(self.y), self.system.states);
  visit_steps(archive, m);
  visit_corrector(archive, m);
  for (int j = 0; j < L_MAX && j <= m.cv_qmax; ++j) many(archive, data(m.cv_zn[j]), self.system.states);
  if (self.progress.armed) visit_roots(archive, m);
  if (self.system.method == Method::bdf && m.cv_nst > 0) visit_newton(archive, self, m);
}

// A solver that has not stepped yet lacks what CVODE sets up in its first step: a step is made, and then forgotten.
bool make_ready(Integrator& integrator, Integrator::Implementation& self, const unsigned char* bytes) {
  Reader reader{bytes};
  Progress saved;
  double y[max_states], t_reached;
  visit_progress(reader, saved);
  many(reader, y, self.system.states);
  const bool stepped = static_cast<CVodeMem>(self.cvode)->cv_nst > 0;
  if (stepped && self.progress.armed == saved.armed) return true;
  if (!integrator.restart(saved.known_until, y, saved.armed != 0)) return false;
  CVode(self.cvode, saved.known_until + self.system.longest_step, self.y, &t_reached, CV_ONE_STEP);
  return true;
}

// The interpolating polynomial in Nordsieck form, sum of z_j s^j with s = (t - t_n) / h: what CVodeGetDky gives,
// without its checks and powers. Even and odd j apart, two chains of Horner that do not wait for each other: it is what
// a master pays for at each communication point.
template <int pairs>
void evaluate(const N_Vector* z, int order, double s, double* y) {
  const int even = order - order % 2, odd = order - 1 + order % 2;
  StatePair sum[2][pairs];
  std::memcpy(sum[0], state_pairs(z[even]), sizeof sum[0]);
  std::memcpy(sum[1], state_pairs(z[odd]), sizeof sum[1]);
  for (int j = even - 2; j >= 0; j -= 2)
    for (int i = 0; i < pairs; ++i) sum[0][i] = sum[0][i] * (s * s) + state_pairs(z[j])[i];
  for (int j = odd - 2; j > 0; j -= 2)
    for (int i = 0; i < pairs; ++i) sum[1][i] = sum[1][i] * (s * s) + state_pairs(z[j])[i];
  for (int i = 0; i < pairs; ++i) sum[0][i] += sum[1][i] * s;
  std::memcpy(y, sum[0], sizeof sum[0]);
}

}  // namespace

void Integrator::read(double t, double* y) const {
  const Progress& progress = self->progress;
  const auto& m = *static_cast<CVodeMem>(self->cvode);
  const bool stepped = m.cv_tn > progress.step_start;
  if (!stepped) return void(std::copy_n(data(self->y), self->system.states, y));
  const double s = (std::clamp(t, progress.step_start, progress.known_until) - m.cv_tn) / m.cv_h;
  self->system.states == 8 ? evaluate<4>(m.cv_zn, m.cv_q, s, y) : evaluate<6>(m.cv_zn, m.cv_q, s, y);
}

bool Integrator::notices(const double* y_dot_before, const double* y_dot_after) const {
  const auto& m = *static_cast<CVodeMem>(self->cvode);
  if (!has_history(m)) return true;
  // Not the weights of the last step: a snapshot does not keep them.
  self->system.weights(self->system.owner, data(m.cv_zn[0]), data(m.cv_ewt));
  double* change = data(self->scratch);
  for (int i = 0; i < self->system.states; ++i) change[i] = m.cv_h * (y_dot_after[i] - y_dot_before[i]);
  return !(state_wrms_norm(self->scratch, m.cv_ewt) < 1);
}

std::size_t Integrator::history_size() const {
  Measure measure;
  visit(measure, *self);
  return measure.bytes;
}

void Integrator::save_history(unsigned char* bytes) const {
  Writer writer{bytes};
  visit(writer, *self);
}

bool Integrator::restore_history(const unsigned char* bytes) {
  if (!make_ready(*this, *self, bytes)) return false;
  Reader reader{bytes};
  visit(reader, *self);
  return true;
}

}  // namespace integrator
