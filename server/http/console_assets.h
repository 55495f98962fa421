// The files of the console, which are part of the program.
#ifndef SERVER_HTTP_CONSOLE_ASSETS_H_
#define SERVER_HTTP_CONSOLE_ASSETS_H_

#include <string>

namespace homing::server {

struct ConsoleAsset {
  const char* type = "";
  std::string text;
  // The same, compressed by gzip.
  std::string gzip;
  // Changes with the content.
  std::string tag;
};

// "/app.js"; null: there is no such file.
const ConsoleAsset* FindConsoleAsset(const std::string& path);

}  // namespace homing::server

#endif  // SERVER_HTTP_CONSOLE_ASSETS_H_
