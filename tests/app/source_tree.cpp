#include "tests/app/source_tree.h"

#include <algorithm>
#include <regex>

#include "base/files/file_io.h"
#include "test_paths.h"

namespace glidelab::tests {
namespace {

namespace fs = std::filesystem;

std::string unit_of(const fs::path& path) {
  return fs::path(path).replace_extension().string();
}

std::set<std::string> reachable_from(const IncludeGraph& graph, const std::string& start) {
  std::set<std::string> seen;
  std::vector<std::string> open = {start};
  while (!open.empty()) {
    const auto node = graph.find(open.back());
    open.pop_back();
    if (node == graph.end()) continue;
    for (const std::string& next : node->second) {
      if (seen.insert(next).second) open.push_back(next);
    }
  }
  return seen;
}

}  // namespace

std::vector<Source> sources_below(const std::vector<std::string>& folders) {
  const fs::path root = kSourceDir;
  std::vector<Source> sources;
  for (const std::string& folder : folders) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string ending = entry.path().extension();
      if (ending != ".h" && ending != ".cpp") continue;
      sources.push_back({fs::relative(entry.path(), root), base::read_file(entry.path())});
    }
  }
  std::sort(sources.begin(), sources.end(), [](const Source& a, const Source& b) { return a.path < b.path; });
  return sources;
}

std::vector<std::string> includes_of(const Source& source) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])", std::regex::multiline);
  std::vector<std::string> includes;
  for (auto match = std::sregex_iterator(source.text.begin(), source.text.end(), kInclude);
       match != std::sregex_iterator(); ++match) {
    includes.push_back((*match)[1]);
  }
  return includes;
}

IncludeGraph folder_graph(const std::vector<Source>& sources) {
  IncludeGraph graph;
  for (const Source& source : sources) graph[source.path.parent_path().string()];
  for (const Source& source : sources) {
    const std::string from = source.path.parent_path().string();
    for (const std::string& include : includes_of(source)) {
      const std::string to = fs::path(include).parent_path().string();
      if (to != from && graph.contains(to)) graph[from].insert(to);
    }
  }
  return graph;
}

IncludeGraph unit_graph(const std::vector<Source>& sources) {
  IncludeGraph graph;
  for (const Source& source : sources) {
    const std::string from = unit_of(source.path);
    for (const std::string& include : includes_of(source)) {
      const fs::path path = include;
      if (path.parent_path() == source.path.parent_path() && unit_of(path) != from) graph[from].insert(unit_of(path));
    }
  }
  return graph;
}

std::vector<std::vector<std::string>> circles_of(const IncludeGraph& graph) {
  std::map<std::string, std::set<std::string>> reached;
  for (const auto& [node, next] : graph) reached[node] = reachable_from(graph, node);
  std::vector<std::vector<std::string>> circles;
  std::set<std::string> placed;
  for (const auto& [node, nodes] : reached) {
    if (placed.contains(node)) continue;
    std::vector<std::string> circle = {node};
    for (const std::string& other : nodes) {
      if (other != node && reached.contains(other) && reached.at(other).contains(node)) circle.push_back(other);
    }
    std::sort(circle.begin(), circle.end());
    placed.insert(circle.begin(), circle.end());
    if (circle.size() > 1) circles.push_back(std::move(circle));
  }
  return circles;
}

}  // namespace glidelab::tests
