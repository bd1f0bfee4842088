#include "base/math/distributions.h"

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/complement.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace glidelab::base {

using boost::math::chi_squared;
using boost::math::complement;
using boost::math::normal;
using boost::math::students_t;

double normal_cdf(double z) {
  return cdf(normal(), z);
}

double normal_tail(double z) {
  return cdf(complement(normal(), z));
}

double normal_quantile(double p) {
  return quantile(normal(), p);
}

double normal_upper_quantile(double p) {
  return quantile(complement(normal(), p));
}

double student_t_tail(double degrees, double t) {
  return cdf(complement(students_t(degrees), t));
}

double student_t_quantile(double degrees, double p) {
  return quantile(students_t(degrees), p);
}

double chi2_quantile(double degrees, double p) {
  return quantile(chi_squared(degrees), p);
}

double chi2_upper_quantile(double degrees, double p) {
  return quantile(complement(chi_squared(degrees), p));
}

double beta_quantile(double a, double b, double p) {
  return quantile(boost::math::beta_distribution<>(a, b), p);
}

}  // namespace glidelab::base
