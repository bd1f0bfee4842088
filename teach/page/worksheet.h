/// Worksheets: a page (A4) for each law with its phase diagram, three questions and lines for answers, and the same
/// page for the teacher, with the answers that the program computed (teach/study/law_questions.h).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "teach/study/law_study.h"

namespace glidelab::teach {

struct Worksheet {
  std::string pdf;      ///< for the class
  std::string answers;  ///< for the teacher; PDF as well
};

/// The questions and their answers as printed, in one of language_codes().
struct WorksheetTexts {
  std::string title, answers_title;
  std::array<std::string, 3> questions, answers;
};
WorksheetTexts worksheet_texts(const LawStudy& study, const std::string& language);

/// One worksheet for each study. EnvironmentError if gnuplot fails.
std::vector<Worksheet> worksheets(const std::vector<LawStudy>& studies, const std::string& language);

}  // namespace glidelab::teach
