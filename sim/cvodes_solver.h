/// CVODES (SUNDIALS) behind one owner of its memory.
///
///     dy/dt = rate(y), y of three components, autonomous; backward differentiation formulas of order 1 to 5 with
///     Newton's method and the Jacobian given; stops at a root of event(y).
///
/// Nothing is printed: what CVODES reports becomes the text of a NumericalError with time, step and tolerances.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>

namespace glidelab::sim {

struct OdeSystem {
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> rate;
  std::function<Eigen::Matrix3d(const Eigen::Vector3d&)> jacobian;  ///< d rate[i] / d y[j]
  std::function<double(const Eigen::Vector3d&)> event;              ///< empty: no event
  int event_crossing = 0;                                           ///< +1 where it rises, -1 where it falls
  double relative_tolerance = 0.0;
  Eigen::Vector3d absolute_tolerance = Eigen::Vector3d::Zero();
};

struct OdeState {
  double t_s = 0.0;
  Eigen::Vector3d y = Eigen::Vector3d::Zero();
  bool at_event = false;
};

class CvodesSolver {
 public:
  /// Ready to move `system` from (t, y). NumericalError where CVODES refuses or there is no memory.
  CvodesSolver(OdeSystem system, double t_s, const Eigen::Vector3d& y);
  ~CvodesSolver();
  CvodesSolver(CvodesSolver&&) noexcept;
  CvodesSolver& operator=(CvodesSolver&&) noexcept;

  /// The state at `t_s` (later than all before, and than the start by more than rounding), or at the event that comes
  /// first. After an event, restart. NumericalError where a step fails.
  OdeState advance(double t_s);

  /// Starts anew with another system: the order falls to 1 and no history is kept.
  void restart(OdeSystem system, double t_s, const Eigen::Vector3d& y);

  /// Steps taken since the construction.
  long steps() const;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace glidelab::sim
