#include "sim/motion/cvodes_solver.h"

#include <cvodes/cvodes.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <exception>
#include <string>
#include <utility>

#include "base/errors.h"

namespace glidelab::sim {

namespace {

// Steps between two requested times. A motion of any length takes a few thousand; more means that a force is not what
// it claims to be.
constexpr long kMaxSteps = 100'000;

OdeVector read(N_Vector vector) {
  return Eigen::Map<const Eigen::VectorXd>(N_VGetArrayPointer(vector), N_VGetLength(vector));
}

void write(const OdeVector& values, N_Vector vector) {
  Eigen::Map<Eigen::VectorXd>(N_VGetArrayPointer(vector), N_VGetLength(vector)) = values;
}

}  // namespace

struct CvodesSolver::Memory {
  OdeSystem system;
  SUNContext context = nullptr;
  N_Vector y = nullptr;
  N_Vector tolerance = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear_solver = nullptr;
  SUNNonlinearSolver iteration = nullptr;
  void* cvodes = nullptr;
  double t_s = 0.0;
  long steps_before = 0;
  std::string message;           // what CVODES reported last
  std::exception_ptr exception;  // thrown by the system, on its way through C

  Memory() = default;
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  ~Memory() {
    if (cvodes != nullptr) CVodeFree(&cvodes);
    if (iteration != nullptr) SUNNonlinSolFree(iteration);
    if (linear_solver != nullptr) SUNLinSolFree(linear_solver);
    if (matrix != nullptr) SUNMatDestroy(matrix);
    if (tolerance != nullptr) N_VDestroy(tolerance);
    if (y != nullptr) N_VDestroy(y);
    if (context != nullptr) SUNContext_Free(&context);
  }

  // Runs a callback: 0 done, 1 not finite (CVODES tries a smaller step), -1 thrown (rethrown after CVODES returns).
  template <class Call>
  int guarded(Call&& call) {
    try {
      return call() ? 0 : 1;
    } catch (...) {
      exception = std::current_exception();
      return -1;
    }
  }

  static int rate(realtype, N_Vector y, N_Vector dydt, void* self) {
    auto& memory = *static_cast<Memory*>(self);
    return memory.guarded([&] {
      const OdeVector rate = memory.system.rate(read(y));
      write(rate, dydt);
      return rate.allFinite();
    });
  }

  static int jacobian(realtype, N_Vector y, N_Vector, SUNMatrix matrix, void* self, N_Vector, N_Vector, N_Vector) {
    auto& memory = *static_cast<Memory*>(self);
    return memory.guarded([&] {
      const OdeMatrix jacobian = memory.system.jacobian(read(y));
      Eigen::Map<Eigen::MatrixXd>(SM_DATA_D(matrix), jacobian.rows(), jacobian.cols()) = jacobian;  // both are
                                                                                                    // column-major
      return jacobian.allFinite();
    });
  }

  static int event(realtype, N_Vector y, realtype* value, void* self) {
    auto& memory = *static_cast<Memory*>(self);
    return memory.guarded([&] {
      *value = memory.system.event(read(y));
      return true;
    });
  }

  static void report(int, const char*, const char*, char* text, void* self) {
    static_cast<Memory*>(self)->message = text;
  }

  void check(bool good, const char* what) {
    if (exception) std::rethrow_exception(std::exchange(exception, nullptr));
    if (good) return;
    double step_s = 0.0;
    if (cvodes != nullptr) CVodeGetCurrentStep(cvodes, &step_s);
    throw base::NumericalError(
        fmt::format("CVODES failed in {} at t = {} s (step {} s, relative tolerance {}, absolute tolerance {}): {}",
                    what, t_s, step_s, system.relative_tolerance, system.absolute_tolerance[1],
                    message.empty() ? "no reason given" : message));
  }

  void use(OdeSystem new_system, double start_s, const OdeVector& start) {
    system = std::move(new_system);
    t_s = start_s;
    write(start, y);
    write(system.absolute_tolerance, tolerance);
  }

  void set_event_and_tolerances() {
    check(CVodeSVtolerances(cvodes, system.relative_tolerance, tolerance) == CV_SUCCESS, "CVodeSVtolerances");
    check(CVodeRootInit(cvodes, system.event ? 1 : 0, event) == CV_SUCCESS, "CVodeRootInit");
    if (!system.event) return;
    int crossing = system.event_crossing;
    check(CVodeSetRootDirection(cvodes, &crossing) == CV_SUCCESS, "CVodeSetRootDirection");
    check(CVodeSetNoInactiveRootWarn(cvodes) == CV_SUCCESS, "CVodeSetNoInactiveRootWarn");
  }

  void use_newton() {
    const sunindextype n = N_VGetLength(y);
    matrix = SUNDenseMatrix(n, n, context);
    check(matrix != nullptr, "SUNDenseMatrix");
    linear_solver = SUNLinSol_Dense(y, matrix, context);
    check(linear_solver != nullptr, "SUNLinSol_Dense");
    check(CVodeSetLinearSolver(cvodes, linear_solver, matrix) == CVLS_SUCCESS, "CVodeSetLinearSolver");
    check(CVodeSetJacFn(cvodes, jacobian) == CVLS_SUCCESS, "CVodeSetJacFn");
  }

  void use_iteration() {
    constexpr int kAcceleration = 0;  // plain functional iteration
    iteration = SUNNonlinSol_FixedPoint(y, kAcceleration, context);
    check(iteration != nullptr, "SUNNonlinSol_FixedPoint");
    check(CVodeSetNonlinearSolver(cvodes, iteration) == CV_SUCCESS, "CVodeSetNonlinearSolver");
  }

  long steps_now() const {
    long steps = 0;
    CVodeGetNumSteps(cvodes, &steps);
    return steps;
  }
};

CvodesSolver::CvodesSolver(OdeSystem system, double t_s, const OdeVector& y) : memory_(std::make_unique<Memory>()) {
  Memory& m = *memory_;
  const bool stiff = static_cast<bool>(system.jacobian);
  m.check(SUNContext_Create(nullptr, &m.context) == 0, "SUNContext_Create");
  m.y = N_VNew_Serial(y.size(), m.context);
  m.tolerance = N_VNew_Serial(y.size(), m.context);
  m.check(m.y != nullptr && m.tolerance != nullptr, "N_VNew_Serial");
  m.cvodes = CVodeCreate(stiff ? CV_BDF : CV_ADAMS, m.context);
  m.check(m.cvodes != nullptr, "CVodeCreate");
  m.check(CVodeSetErrHandlerFn(m.cvodes, Memory::report, &m) == CV_SUCCESS, "CVodeSetErrHandlerFn");
  m.use(std::move(system), t_s, y);
  m.check(CVodeInit(m.cvodes, Memory::rate, t_s, m.y) == CV_SUCCESS, "CVodeInit");
  m.check(CVodeSetUserData(m.cvodes, &m) == CV_SUCCESS, "CVodeSetUserData");
  m.set_event_and_tolerances();
  if (stiff) {
    m.use_newton();
  } else {
    m.use_iteration();
  }
  m.check(CVodeSetMaxNumSteps(m.cvodes, kMaxSteps) == CV_SUCCESS, "CVodeSetMaxNumSteps");
}

CvodesSolver::~CvodesSolver() = default;
CvodesSolver::CvodesSolver(CvodesSolver&&) noexcept = default;
CvodesSolver& CvodesSolver::operator=(CvodesSolver&&) noexcept = default;

OdeState CvodesSolver::advance(double t_s) {
  Memory& m = *memory_;
  const int flag = CVode(m.cvodes, t_s, m.y, &m.t_s, CV_NORMAL);
  m.check(flag >= 0, "CVode");
  return {.t_s = m.t_s, .y = read(m.y), .at_event = flag == CV_ROOT_RETURN};
}

void CvodesSolver::restart(OdeSystem system, double t_s, const OdeVector& y) {
  Memory& m = *memory_;
  m.steps_before += m.steps_now();
  m.use(std::move(system), t_s, y);
  m.check(CVodeReInit(m.cvodes, t_s, m.y) == CV_SUCCESS, "CVodeReInit");
  m.set_event_and_tolerances();
}

long CvodesSolver::steps() const {
  return memory_->steps_before + memory_->steps_now();
}

}  // namespace glidelab::sim
