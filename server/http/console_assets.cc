#include "server/http/console_assets.h"

#include <zlib.h>

#include <map>
#include <string_view>

#include "absl/strings/str_cat.h"

// Defines `name` and `name_end` around the bytes of a file.
#define HOMING_EMBED(name, file)                                          \
  __asm__(".section .rodata\n.global " #name "\n" #name                   \
          ":\n"                                                           \
          ".incbin \"" HOMING_CONSOLE_DIST "/" file                       \
          "\"\n"                                                          \
          ".global " #name "_end\n" #name "_end:\n.byte 0\n.previous\n"); \
  extern "C" const char name[];                                           \
  extern "C" const char name##_end[]

HOMING_EMBED(homing_console_html, "index.html");
HOMING_EMBED(homing_console_js, "app.js");
HOMING_EMBED(homing_console_css, "app.css");
HOMING_EMBED(homing_console_worker, "worker.js");
HOMING_EMBED(homing_console_icon, "icon.svg");

#undef HOMING_EMBED

namespace homing::server {
namespace {

std::string Gzip(const std::string& text) {
  constexpr int kGzipWindow = 15 + 16;
  z_stream stream{};
  if (deflateInit2(&stream, 9, Z_DEFLATED, kGzipWindow, 9, Z_DEFAULT_STRATEGY) != Z_OK) return "";
  std::string packed(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const bool whole = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  packed.resize(whole ? stream.total_out : 0);
  deflateEnd(&stream);
  return packed;
}

ConsoleAsset Make(const char* type, const char* begin, const char* end) {
  ConsoleAsset asset;
  asset.type = type;
  asset.text.assign(begin, end);
  asset.gzip = Gzip(asset.text);
  asset.tag = absl::StrCat(
      "\"", crc32(0, reinterpret_cast<const Bytef*>(begin), static_cast<uInt>(end - begin)), "-",
      asset.text.size(), "\"");
  return asset;
}

}  // namespace

const ConsoleAsset* FindConsoleAsset(const std::string& path) {
  static const std::map<std::string, ConsoleAsset> assets = {
      {"/", Make("text/html; charset=utf-8", homing_console_html, homing_console_html_end)},
      {"/app.js", Make("text/javascript; charset=utf-8", homing_console_js, homing_console_js_end)},
      {"/app.css", Make("text/css; charset=utf-8", homing_console_css, homing_console_css_end)},
      {"/worker.js",
       Make("text/javascript; charset=utf-8", homing_console_worker, homing_console_worker_end)},
      {"/icon.svg", Make("image/svg+xml", homing_console_icon, homing_console_icon_end)},
  };
  const auto found = assets.find(path);
  return found == assets.end() ? nullptr : &found->second;
}

}  // namespace homing::server
