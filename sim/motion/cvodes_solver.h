/// CVODES (SUNDIALS), wrapped in one owner of its memory.
///
///     dy/dt = rate(y), autonomous, up to kMostComponents components; stops at a root of event(y).
///
/// With a Jacobian: backward differentiation formulas of order 1 to 5 with Newton's method. Without one, for systems
/// that are not stiff: Adams formulas of order 1 to 12 with functional iteration.
///
/// Nothing is printed: CVODES' report becomes the text of a NumericalError with time, step and tolerances.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>

namespace glidelab::sim {

inline constexpr int kMostComponents = 32;
using OdeVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostComponents, 1>;
using OdeMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostComponents, kMostComponents>;

struct OdeSystem {
  std::function<OdeVector(const OdeVector&)> rate;
  std::function<OdeMatrix(const OdeVector&)> jacobian;  ///< d rate[i] / d y[j]; empty: Adams
  std::function<double(const OdeVector&)> event;        ///< empty: no event
  int event_crossing = 0;                               ///< +1: rising; -1: falling
  double relative_tolerance = 0.0;
  OdeVector absolute_tolerance;  ///< of each component
};

struct OdeState {
  double t_s = 0.0;
  OdeVector y;
  bool at_event = false;
};

class CvodesSolver {
 public:
  /// Prepares to move `system` from (t, y). NumericalError if CVODES refuses or there is no memory.
  CvodesSolver(OdeSystem system, double t_s, const OdeVector& y);
  ~CvodesSolver();
  CvodesSolver(CvodesSolver&&) noexcept;
  CvodesSolver& operator=(CvodesSolver&&) noexcept;

  /// The state at `t_s`, or at an event that comes first. `t_s` must be later than all times before, and later than the
  /// start by more than rounding. After an event, restart. NumericalError if a step fails.
  OdeState advance(double t_s);

  /// Starts again with another system of the same size and kind: the order falls to 1 and no history is kept.
  void restart(OdeSystem system, double t_s, const OdeVector& y);

  /// Steps taken since construction.
  long steps() const;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace glidelab::sim
