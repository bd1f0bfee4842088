/// base/number_text.h under the pages' own names.
#pragma once

#include "base/number_text.h"

namespace glidelab::report {

using base::digits_text;
using base::error_text;
using base::gain_text;
using base::number_text;
using base::r2_text;
using base::sd_text;
using base::value_and_sd_text;
using base::value_text;
using base::with_raised_power;

}  // namespace glidelab::report
