#include "report/text/why_words.h"

#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/result/results.h"
#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::core;

TEST_CASE("every reason for a missing quantity has words, with its numbers") {
  const std::vector<std::pair<AnyReason, std::string>> reasons = {
      {unknown::Told{"not done after 60 s"}, "not done after 60 s"},
      {unknown::NoLine{}, "no line: neither direction"},
      {unknown::NoDownhillLine{}, "no line for v > 0"},
      {unknown::SpeedHardlyChanges{}, "the speed hardly changes"},
      {unknown::NotBothLines{true, false, true},
       "only motion in both directions separates friction from inclination, unless the inclination"},
      {unknown::NotBothLines{true, false}, "no line for v < 0; only motion in both directions"},
      {unknown::NotBothLines{false, true}, "no line for v > 0; only motion in both directions"},
      {unknown::NotBothLines{true, true}, "no line for v < 0 and none for v > 0; only motion in both directions"},
      {unknown::MeanBeyondGravity{10.5}, "the mean of a0 is 10.5 m/s², which is gravity or more"},
      {unknown::RateNotPositive{true}, "K/m for v > 0 is not above zero"},
      {unknown::RateNotPositive{false}, "K/m is not above zero"},
      {unknown::InterceptNotPositive{},
       "nothing drives the glider downhill: at v = 0 the line for v > 0 is not above zero"},
      {unknown::NoFreeMotion{}, "no free motion"},
      {unknown::NoFit{}, "does not converge"},
      {unknown::OneDirection{1, 0.6874, 0.0012},
       "motion with v > 0 only: it determines g (sin(alpha) - mu cos(alpha)) = 0.6874 ± 0.0012 m/s²"},
      {unknown::OneDirection{-1, 0.7, 0.01, true}, "separately, unless the inclination is stated with its uncertainty"},
      {unknown::OneDirection{-1, 0.7, 0.01}, "v < 0 only: it determines g (sin(alpha) + mu cos(alpha))"},
      {unknown::NoDownhillMotion{}, "no motion with v > 0"},
      {unknown::DriveBeyondGravity{}, "exceeds gravity"},
      {unknown::NotTold{}, "did not say why"},
      {unknown::NotAnswered{}, "no such configuration"},
      {unknown::NoLineOfMotion{}, "does not move"},
      {unknown::NotToldApart{}, "do not separate it"},
      {unknown::NoMinimum{}, "stopped before it reached a minimum"},
      {unknown::AtItsLimit{}, "at the limit of what is allowed"},
      {unknown::ExplanationsDiffer{}, "differ too much"},
      {unknown::FreeFall{}, "no normal force"},
      {unknown::NoBalance{}, "not balance at any downhill speed"},
      {unknown::DragNotViscous{}, "square of the speed"},
      {unknown::KernelNotStated{}, "neither the bandwidth nor the stretch"}};
  std::vector<bool> seen(std::variant_size_v<AnyReason>, false);
  for (const auto& [reason, part] : reasons) {
    const std::string words = report::why_words(WhyUnknown{reason});
    INFO(words);
    CHECK(words.find(part) != std::string::npos);
    seen[reason.index()] = true;
  }
  for (std::size_t kind = 0; kind < seen.size(); ++kind) {
    INFO("kind " << kind);
    CHECK(seen[kind]);
  }
  CHECK(report::why_words({}).empty());
}

TEST_CASE("a missing line is explained by what leaves the positions out, and gaps by the estimator that bridges them") {
  const std::string gaps =
      report::why_words(WhyUnknown{unknown::NoLine{35, {{LeftOut::kernel_gap, 20}, {LeftOut::hand, 9}}}});
  CHECK(gaps.find("left out are 20 of 35 positions (kernel over a gap), 9 (hand). ") != std::string::npos);
  CHECK(gaps.find("--estimator trajectory") != std::string::npos);
  const std::string rest = report::why_words(WhyUnknown{unknown::NoLine{35, {{LeftOut::rest, 30}}}});
  CHECK(rest.find("left out are 30 of 35 positions (at rest)") != std::string::npos);
  CHECK(rest.find("--estimator") == std::string::npos);
}

TEST_CASE("a reason names the clips whose motion went against the launch, and when the launch begins") {
  const AgainstLaunch turning{1, 0.542, 0.4, true}, whole{-1, {}, 1.0, false};
  CHECK(report::why_words(WhyUnknown{unknown::NoDownhillLine{}, {{"up", turning}, {"down", whole}}}) ==
        "no line for v > 0; up: motion towards +x before 0.542 s is attributed to the hand and excluded, since the "
        "launch was towards -x (as launched and downhill in experiment.toml say); down: it moves towards -x only: the "
        "launch was towards +x (as launched and downhill in experiment.toml say)");
}
