/// report.html of `diagnose`: one page that needs nothing but itself.
#pragma once

#include <string>

#include "diagnose/diagnosis.h"
#include "report/html.h"

namespace glidelab::report {

/// `title` names what was diagnosed. EnvironmentError where gnuplot fails.
Page diagnosis_report(const std::string& title, const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
