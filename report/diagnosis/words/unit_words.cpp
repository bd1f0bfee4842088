#include "report/diagnosis/words/unit_words.h"

#include <fmt/format.h>

#include <variant>

#include "report/check/finding_words.h"

namespace glidelab::report {
namespace {

std::string first_to_check(const diagnose::DoubtfulUnit& of) {
  const FindingWords words = finding_words(of.found);
  if (std::holds_alternative<core::found::FallsSlowly>(of.found)) {
    return fmt::format(
        "First find out why it falls so slowly ({}: {}). Unless a liquid carries it, nothing below holds.", of.clip,
        words.found);
  }
  const bool scale = std::holds_alternative<core::found::FallAboveGravity>(of.found);
  return fmt::format("First {} ({}: {}). {}.", words.advice, of.clip, words.found,
                     scale ? "Drag and friction cannot explain that" : "In another unit, nothing below holds");
}

}  // namespace

std::string unit_words(const diagnose::Diagnosis& diagnosis) {
  for (const diagnose::Note& note : diagnosis.notes) {
    if (const auto* const of = std::get_if<diagnose::DoubtfulUnit>(&note)) return first_to_check(*of);
  }
  return {};
}

}  // namespace glidelab::report
