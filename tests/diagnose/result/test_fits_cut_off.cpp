#include <optional>
#include <vector>

#include "diagnose/result/diagnosis.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

diagnose::RankedExplanation ranked(const char* id, double probability, bool converged) {
  diagnose::RankedExplanation one;
  one.explanation = {{id}, false};
  one.probability = probability;
  one.converged = converged;
  return one;
}

}  // namespace

TEST_CASE("a likely explanation whose fit was cut off is told, an unlikely one or a settled one is not") {
  const std::vector<diagnose::RankedExplanation> settled = {ranked("tether", 0.8, true),
                                                            ranked("eddy_rolloff", 0.001, false)};
  CHECK_FALSE(diagnose::fits_cut_off(settled));
  std::vector<diagnose::RankedExplanation> cut = settled;
  cut.push_back(ranked("quadratic_drag", 0.05, false));
  const std::optional<diagnose::FitsCutOff> told = diagnose::fits_cut_off(cut);
  REQUIRE(told);
  REQUIRE(told->of.size() == 1);
  CHECK(told->of.front() == diagnose::Explanation{{"quadratic_drag"}, false});
}
