/// A diagnosis for the reader: report.html of `diagnose`, one self-contained page, and text for a terminal.
#pragma once

#include <string>
#include <vector>

#include "diagnose/result/diagnosis.h"
#include "report/html/html.h"
#include "validate/film/twin_motions.h"

namespace glidelab::report {

/// `title` names what was diagnosed; `twin`, if requested, is shown with the data. EnvironmentError if gnuplot fails.
Page diagnosis_report(const std::string& title, const diagnose::Diagnosis& diagnosis,
                      const std::vector<validate::TwinMotion>& twin = {});

/// Summary, ranking, gap, what to record next, notes.
std::string diagnosis_text(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
