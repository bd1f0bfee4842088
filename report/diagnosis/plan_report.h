/// Which effects an experiment will be able to distinguish: a file, a text, a page.
#pragma once

#include <string>

#include "diagnose/next/plan.h"
#include "report/html/html.h"

namespace glidelab::report {

/// One JSON object, with a newline at its end. No number in it is NaN.
std::string plan_json(const diagnose::Plan& plan);

/// The detectable effects, as a table for a terminal, and what to do about effects that look alike.
std::string plan_text(const diagnose::Plan& plan);

/// The same as a page, with the method. EnvironmentError if gnuplot fails.
Page plan_page(const std::string& title, const diagnose::Plan& plan);

}  // namespace glidelab::report
