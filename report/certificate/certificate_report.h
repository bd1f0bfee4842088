/// Whether a recording's intervals can be trusted (validate/study/certify/certificate.h), as certify.json, for a
/// terminal, and as a page.
#pragma once

#include <string>
#include <vector>

#include "report/html/html.h"
#include "report/html/plot.h"
#include "validate/study/certify/certificate.h"

namespace glidelab::report {

/// "Intervals of K/m, µ, α hold in 94 % (90 to 97 %) of recordings like yours; µ is off by 0.3 of its standard
/// deviation on average." Text, one line without its end.
std::string certificate_answer(const validate::Certificate& certificate);

/// At most three that reduce the errors by a tenth or more, the largest gain first: "Use more light. With half the
/// noise, K/m, µ, α err 45 % (38 to 51 %) less". Text.
std::vector<std::string> best_changes(const validate::Certificate& certificate);

/// The fraction of each quantity's intervals that contain the truth, with its own interval.
Plot certificate_plot(const validate::Certificate& certificate);

std::string certificate_json(const validate::Certificate& certificate);
std::string certificate_text(const validate::Certificate& certificate);
/// `name` is that of the recording.
Page certificate_page(const std::string& name, const validate::Certificate& certificate);

}  // namespace glidelab::report
