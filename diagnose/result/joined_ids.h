/// The ids of an explanation's effects as one text, as in diagnosis.json and tables: "quadratic_drag + track_bow".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace glidelab::diagnose {

std::string joined_ids(const std::vector<std::string>& ids);

/// The ids in such a text: joined_ids() backwards. At least one, which is empty for an empty text.
std::vector<std::string> split_ids(std::string_view text);

}  // namespace glidelab::diagnose
