/// The groups of an experiment folder: which clips share a set-up of the track, and so one inclination.
#pragma once

#include <vector>

#include "base/toml/strict_toml.h"
#include "core/experiment/clip_setup.h"

namespace glidelab::core {

/// One group for each stated inclination among the clips that name none; "all" where that makes one group in all.
void name_groups(std::vector<ClipSetup>& clips);

/// Rejects names that two clips or two groups have, and groups without a clip. The tables belong to the clips and
/// groups.
void check_names(const std::vector<ClipSetup>& clips, const std::vector<base::TomlTable>& clip_tables,
                 const std::vector<GroupSetup>& groups, const std::vector<base::TomlTable>& group_tables);

/// Rejects an inclination that another clip of the group contradicts(): a group has one.
void check_readings(const std::vector<ClipSetup>& clips, const std::vector<base::TomlTable>& clip_tables);

}  // namespace glidelab::core
