// Text inside XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace cli {

/// With & < > " escaped; characters XML does not know become spaces. For element text and attributes in double quotes.
inline std::string in_xml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += static_cast<unsigned char>(c) < 32 && c != '\n' && c != '\t' ? ' ' : c;
  }
  return out;
}

}  // namespace cli
