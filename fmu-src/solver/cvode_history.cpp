// CVODE's history as plain numbers, so that a restored solution goes on bit-identically.
//
// CVODE has no call for this, so its memory record (private headers of the pinned source) is read and written field by
// field. Only this file includes those headers. What CVODE
// computes anew at the start of each step (error weights, work vectors) is left out.
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_newton.h>

#include <algorithm>

#include "bytes.hpp"
#include "cvode_engine.hpp"
#include "cvode_impl.h"
#include "cvode_ls_impl.h"
#include "cvode_objects.hpp"

namespace solver {
namespace {

constexpr long long most = 9007199254740992;

using support::Archive;

template <class... Fields>
void counts(Archive& archive, long long least, long long greatest, Fields&... fields) {
  (archive.count(fields, least, greatest), ...);
}

void visit_steps(Archive& archive, CVodeMemRec& m) {
  counts(archive, 1, m.cv_qmax, m.cv_q, m.cv_qprime, m.cv_qu);
  archive.count(m.cv_next_q, 0, m.cv_qmax);
  archive.count(m.cv_L, m.cv_q + 1, m.cv_q + 1);
  archive.count(m.cv_qwait, 0, L_MAX + 1);
  archive.count(m.cv_indx_acor, 0, m.cv_qmax);
  constexpr double least = std::numeric_limits<double>::min(), greatest = Archive::greatest;
  for (double* size : {&m.cv_h, &m.cv_hprime, &m.cv_next_h, &m.cv_eta, &m.cv_hscale, &m.cv_hu, &m.cv_h0u})
    archive.range(*size, least, greatest);
  archive.number(m.cv_tn, m.cv_tretlast);
  archive.numbers(m.cv_tau, L_MAX + 1);
  archive.numbers(m.cv_tq, NUM_TESTS + 1);
  archive.numbers(m.cv_l, L_MAX);
  archive.number(m.cv_saved_tq5, m.cv_tolsf);
  archive.range(m.cv_etamax, least, greatest);
  archive.number(m.cv_etaqm1, m.cv_etaq, m.cv_etaqp1);
  archive.number(m.cv_rl1, m.cv_gamma, m.cv_gammap, m.cv_gamrat, m.cv_crate, m.cv_delp, m.cv_acnrm);
  archive.count(m.cv_nst, 1, most);
  counts(archive, 0, most, m.cv_nfe, m.cv_ncfn, m.cv_nni, m.cv_nnf, m.cv_netf, m.cv_nsetups, m.cv_nstlp, m.cv_nscon);
  counts(archive, 0, 2, m.cv_acnrmcur, m.convfail, m.cv_jcur);
}

// The factorised Newton matrix of BDF.
void visit_newton(Archive& archive, CvodeObjects& o, CVodeMemRec& m) {
  auto& interface = *static_cast<CVLsMem>(m.cv_lmem);
  auto& newton = *static_cast<SUNNonlinearSolverContent_Newton>(m.NLS->content);
  auto& dense = *static_cast<SUNLinearSolverContent_Dense>(o.linear->content);
  const int n = o.states;
  counts(archive, 0, 1, interface.jbad, newton.jcur);
  counts(archive, 0, most, interface.nje, interface.nstlj, interface.nfeDQ);
  archive.number(interface.tnlj);
  archive.count(dense.last_flag, 0, 0);
  archive.numbers(SUNDenseMatrix_Data(interface.A), n * n);
  archive.numbers(SUNDenseMatrix_Data(interface.savedJ), n * n);
  for (int i = 0; i < n; ++i) archive.count(dense.pivots[i], i, n - 1);
}

// Ready for numbers that are read: what CVODE does before its first step alone.
bool set_up_history(CvodeObjects& o, CVodeMemRec& m, double t) {
  if (CVodeReInit(&m, t, o.y) != CV_SUCCESS) return false;
  m.cv_e_data = m.cv_user_data;
  return (!m.cv_linit || m.cv_linit(&m) == CV_SUCCESS) && cvNlsInit(&m) == CV_SUCCESS;
}

}  // namespace

void Cvode::visit(Archive& archive, const Problem& problem, const Step& step) {
  Next next = next_;
  archive.count(next, 0, static_cast<int>(Next::starts_after_stop));
  const bool has_history = step.end > step.start;
  if (archive.reads()) {
    if ((!has_history && next == Next::goes_on) || !start(problem)) return archive.refuse();
    next_ = next;
  }
  if (!has_history) return;
  CvodeObjects& o = *objects_;
  auto& m = *static_cast<CVodeMem>(o.cvode);
  if (archive.reads() && !set_up_history(o, m, step.end)) return archive.refuse();
  visit_steps(archive, m);
  for (int j = 0; j <= m.cv_qmax; ++j) archive.numbers(data(m.cv_zn[j]), o.states);
  if (method_ == Method::bdf) visit_newton(archive, o, m);
  if (!archive.fits()) objects_.reset();  // nothing stays of numbers that no solver wrote
}

}  // namespace solver
