#include "core/track/container/xml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "base/errors.h"

namespace glidelab::core {

pugi::xml_document parse_xml(std::string_view xml, const std::string& shown_as, const std::string& wanted,
                             BlankText blank_text) {
  const unsigned int blanks = blank_text == BlankText::kept ? pugi::parse_ws_pcdata_single : 0U;
  pugi::xml_document document;
  const pugi::xml_parse_result result =
      document.load_buffer(xml.data(), xml.size(), pugi::parse_default | pugi::parse_doctype | blanks);
  if (!result) {
    const auto until = xml.substr(0, static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0)));
    const auto line = static_cast<int>(1 + std::count(until.begin(), until.end(), '\n'));
    throw base::InputError(base::Issue{
        shown_as, line, "", fmt::format("XML that breaks off or is damaged ({})", result.description()), wanted});
  }
  for (const pugi::xml_node node : document.children()) {
    if (node.type() != pugi::node_doctype) continue;
    throw base::InputError(base::Issue{shown_as, 0, "", "XML with a document type", wanted});
  }
  return document;
}

}  // namespace glidelab::core
