#include "core/experiment/local_gravity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace glidelab::core {
namespace {

constexpr double kTextbookGravity_m_s2 = 9.81;  // what most programs and books write, wherever they are

}  // namespace

double gravity_sd_m_s2(double gravity_m_s2) {
  if (gravity_m_s2 == kStandardGravity_m_s2 || gravity_m_s2 == kTextbookGravity_m_s2) return kLocalGravity_sd_m_s2;
  const std::string digits = fmt::format("{}", gravity_m_s2);  // the shortest that reads back as the same number
  const std::size_t point = digits.find('.'), power = digits.find('e');
  const std::size_t end = power == std::string::npos ? digits.size() : power;
  double decimals = point == std::string::npos ? 0.0 : static_cast<double>(end - point - 1);
  if (power != std::string::npos) decimals -= std::stod(digits.substr(power + 1));
  return std::min(kLocalGravity_sd_m_s2, 0.5 * std::pow(10.0, -decimals) / std::sqrt(3.0));
}

Gravity stated_gravity(std::optional<double> m_s2, std::optional<double> sd_m_s2) {
  const double value_m_s2 = m_s2.value_or(kStandardGravity_m_s2);
  return {value_m_s2, sd_m_s2 ? *sd_m_s2 : gravity_sd_m_s2(value_m_s2)};
}

}  // namespace glidelab::core
