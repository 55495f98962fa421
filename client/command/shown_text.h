// Text as it may be shown on a terminal.
#ifndef CLIENT_COMMAND_SHOWN_TEXT_H_
#define CLIENT_COMMAND_SHOWN_TEXT_H_

#include <string>
#include <string_view>

namespace homing::client {

// A server or a file's name may hold control characters, which command a terminal: they become
// \u001b, as in JSON, except for new lines and tabs. So do characters that reverse the direction of
// writing.
std::string ShownText(std::string_view text);

}  // namespace homing::client

#endif  // CLIENT_COMMAND_SHOWN_TEXT_H_
