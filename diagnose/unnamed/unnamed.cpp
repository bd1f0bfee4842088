#include "diagnose/unnamed/unnamed.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "diagnose/gap/held_out.h"
#include "diagnose/unnamed/unnamed_members.h"
#include "diagnose/unnamed/unnamed_places.h"

namespace glidelab::diagnose {

std::vector<UnnamedFamily> unnamed_families(const ScoreSpace& space) {
  std::vector<UnnamedFamily> families;
  add_place_families(space, families);
  add_member_families(space, families);
  const UnnamedFamily* shared = likeliest_shared(families);
  for (UnnamedFamily& family : families) {
    if (&family != shared) family.columns.resize(0, 0);
  }
  return families;
}

const UnnamedFamily* likeliest_shared(const std::vector<UnnamedFamily>& families) {
  const UnnamedFamily* likeliest = nullptr;
  for (const UnnamedFamily& family : families) {
    if (family.variable == "clip" || family.columns.cols() == 0) continue;
    if (likeliest == nullptr || family.log_evidence > likeliest->log_evidence) likeliest = &family;
  }
  return likeliest;
}

MotionFit with_unnamed(const TrackSet& set, const MotionFit& fit, const UnnamedFamily& family) {
  MotionFit with = fit;
  const Eigen::Index before = fit.at.global.size(), more = family.columns.cols();
  with.at.global.conservativeResize(before + more);
  with.at.global.tail(more).setZero();
  Eigen::Index from = 0;
  for (FitMotion& motion : with.motions) {
    const Eigen::Index n = motion.residual.size();
    motion.global.conservativeResize(Eigen::NoChange, before + more);
    motion.global.rightCols(more) = family.columns.middleRows(from, n);
    from += n;
  }
  for (Eigen::Index b = 0; b < more && std::isfinite(family.tau); ++b) {
    with.statements.push_back({static_cast<std::size_t>(before + b), 0.0, family.tau, "", false});
  }
  return at_linear_minimum(set, std::move(with));
}

double log_unnamed_evidence(const std::vector<UnnamedFamily>& families) {
  std::map<std::string, std::vector<double>> by_variable;
  for (const UnnamedFamily& family : families) by_variable[family.variable].push_back(family.log_evidence);
  std::vector<double> logs;
  for (const auto& [variable, of_one] : by_variable) logs.push_back(log_mean(of_one));
  return log_mean(logs);
}

}  // namespace glidelab::diagnose
