/// What an experiment will be able to tell apart: a file, a text, a page.
#pragma once

#include <string>

#include "diagnose/plan.h"
#include "report/html.h"

namespace glidelab::report {

std::string plan_json(const diagnose::Plan& plan);
std::string plan_text(const diagnose::Plan& plan);
/// EnvironmentError where gnuplot fails.
Page plan_page(const std::string& title, const diagnose::Plan& plan);

}  // namespace glidelab::report
