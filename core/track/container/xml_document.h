/// XML from outside, read by pugixml.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <string_view>

namespace glidelab::core {

/// What becomes of a text of blanks alone. Between elements, blanks are never text.
enum class BlankText { dropped, kept };

/// InputError, with the line, if the XML is damaged, or if it has a document type, which may define entities.
/// `shown_as` is the file and `wanted` what it should be, for messages.
pugi::xml_document parse_xml(std::string_view xml, const std::string& shown_as, const std::string& wanted,
                             BlankText blank_text = BlankText::dropped);

}  // namespace glidelab::core
