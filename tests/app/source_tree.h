/// The sources as text, and who includes whom: for the tests that hold the code to its layout.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace glidelab::tests {

struct Source {
  std::filesystem::path path;  ///< relative to the root: "core/analysis/analyze.cpp"
  std::string text;
};

/// All headers and sources below these folders of the root, sorted by path.
std::vector<Source> sources_below(const std::vector<std::string>& folders);

/// What a source includes, as written between the quotes or brackets.
std::vector<std::string> includes_of(const Source& source);

/// Who includes whom, by name.
using IncludeGraph = std::map<std::string, std::set<std::string>>;

/// Folders by the includes of their files; what is no folder of these sources is left out.
IncludeGraph folder_graph(const std::vector<Source>& sources);

/// Units (a header and the source of its name: "core/analysis/analyze") by their includes within their own folder.
IncludeGraph unit_graph(const std::vector<Source>& sources);

/// The strongly connected components of more than one member, each sorted.
std::vector<std::vector<std::string>> circles_of(const IncludeGraph& graph);

}  // namespace glidelab::tests
