#include "python/binding/given_scenario.h"

#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"

namespace glidelab::python {

std::string text_of(const GivenScenario& given) {
  return given.second ? *given.second : base::read_file(given.first);
}

render::Scenario read_scenario(const GivenScenario& given, render::ScenarioChecks checks) {
  try {
    return render::read_scenario(text_of(given), given.first, checks);
  } catch (const base::InputError& error) {
    if (!given.second) throw;
    std::vector<base::Issue> issues = error.issues();
    for (base::Issue& issue : issues) {
      if (issue.file == given.first) issue.line = 0;  // a dict has no lines
    }
    throw base::InputError(std::move(issues));
  }
}

}  // namespace glidelab::python
