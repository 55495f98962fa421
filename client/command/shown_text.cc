#include "client/command/shown_text.h"

#include "absl/strings/str_format.h"

namespace homing::client {
namespace {

struct Character {
  char32_t code = 0;
  std::size_t bytes = 1;
};

// The character at the beginning of UTF-8 text; 0 for those that are never hidden. Only what is
// hidden must be read: it takes at most three bytes.
Character First(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  if (byte(0) < 0x80) return {byte(0), 1};
  if (byte(0) == 0xC2) return {byte(1), 2};
  if (byte(0) == 0xE2) return {0x2000U | (byte(1) & 0x3FU) << 6U | (byte(2) & 0x3FU), 3};
  return {};
}

bool IsHidden(char32_t code, std::size_t bytes) {
  if (code == '\n' || code == '\t') return false;
  if (bytes == 1) return (code < 0x20 && code != 0) || code == 0x7F;
  if (bytes == 2) return code >= 0x80 && code < 0xA0;
  return (code >= 0x200E && code <= 0x200F) || (code >= 0x202A && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069);
}

}  // namespace

std::string ShownText(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const auto [code, bytes] = First(text);
    if (bytes <= text.size() && IsHidden(code, bytes)) {
      shown += absl::StrFormat("\\u%04x", static_cast<unsigned>(code));
      text.remove_prefix(bytes);
    } else {
      shown += text.front();
      text.remove_prefix(1);
    }
  }
  return shown;
}

}  // namespace homing::client
