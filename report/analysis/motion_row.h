/// A row of a file of smoothed motion: numbers, and empty fields where there is none.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "base/errors.h"
#include "base/text/csv.h"
#include "core/result/results.h"

namespace glidelab::report {

/// Of one frame of the clip, at t_s. Table and clip outlive it.
class MotionRow {
 public:
  MotionRow(base::CsvWriter& table, const core::ClipResult& clip, double t_s) : table_(table), clip_(clip), t_s_(t_s) {}
  /// NumericalError where the number is not finite; it names the clip and the time.
  void put(std::optional<double> value) {
    if (!value) {
      table_.empty();
    } else if (std::isfinite(*value)) {
      table_.number(*value);
    } else {
      throw base::NumericalError(
          fmt::format("clip \"{}\": the smoothed motion at t = {} s is not finite", clip_.name, t_s_));
    }
  }

 private:
  base::CsvWriter& table_;
  const core::ClipResult& clip_;
  double t_s_;
};

}  // namespace glidelab::report
