// Clients that use up the server's file descriptors, HTTP threads or header memory.
#include <httplib.h>

#include <chrono>
#include <fstream>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/config/health_check.h"
#include "tests/faults/checks.h"
#include "tests/faults/process_figures.h"
#include "tests/faults/raw_socket.h"
#include "tests/faults/server_under_test.h"
#include "tests/support/temporary_folder.h"

namespace homing::faults {
namespace {

using std::chrono::steady_clock;

constexpr char kNginx[] = "/usr/sbin/nginx";

double SecondsSince(steady_clock::time_point begin) {
  return std::chrono::duration<double>(steady_clock::now() - begin).count();
}

int PortOf(const std::string& address) { return std::stoi(address.substr(address.rfind(':') + 1)); }

// Opens more connections than the server has file descriptors, and closes them.
void CheckDescriptors(const Programs& programs, Figures* figures) {
  const TemporaryFolder folder;
  ServerUnderTest server(programs.server, folder.File(""));
  if (!server.Start({"prlimit", "--nofile=96:96"}, {"--http", "off"})) {
    return figures->Failed("descriptors", "no server");
  }
  {
    std::vector<RawSocket> all;
    for (int i = 0; i < 150; ++i) all.emplace_back(PortOf(server.address()));
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  const auto begin = steady_clock::now();
  bool serves = false;
  while (!serves && SecondsSince(begin) < 30) serves = server::CheckHealth(server.address()).ok();
  figures->Holds("descriptors_used_up_serves_again", serves);
  figures->AtMost("descriptors_used_up_serves_again_s", SecondsSince(begin), 5);
  figures->AtMost("descriptors_used_up_exit_code", server.Stop(), 0);
}

// Requests that never end hold all threads that one address may have.
void CheckSlowHttp(const Programs& programs, Figures* figures) {
  const TemporaryFolder folder;
  ServerUnderTest server(programs.server, folder.File(""));
  const int port = RawSocket::FreePort();
  if (!server.Start({}, {"--http", absl::StrCat("127.0.0.1:", port)})) {
    return figures->Failed("slow_http", "no server");
  }
  std::vector<RawSocket> slow;
  double longest = 0;
  for (int second = 0; second < 8; ++second) {
    for (int i = 0; i < 10; ++i) {
      slow.emplace_back(port, "127.0.0.3");
      slow.back().Send("GET /metrics HTTP/1.1\r\nX: ");
    }
    for (const RawSocket& client : slow) client.Send("x");
    const auto begin = steady_clock::now();
    const auto answer = httplib::Client("127.0.0.1", port).Get("/metrics");
    longest = std::max(longest, answer && answer->status == 200 ? SecondsSince(begin) : 1e3);
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  figures->AtMost("slow_http_longest_scrape_s", longest, 1);
  const auto begin = steady_clock::now();
  figures->AtMost("slow_http_exit_code", server.Stop(), 0);
  figures->AtMost("slow_http_end_s", SecondsSince(begin), 6);
}

std::string Frame(char type, char flags, char stream, const std::string& content) {
  const auto size = static_cast<std::uint32_t>(content.size());
  std::string frame;
  for (const int shift : {16, 8, 0}) frame += static_cast<char>(size >> shift);
  return frame + type + flags + std::string(3, '\0') + stream + content;
}

// HPACK: a literal that is not indexed. The value has less than 16 KiB.
std::string Literal(const std::string& name, const std::string& value) {
  std::string text(1, '\0');
  text += static_cast<char>(name.size());
  text += name;
  if (value.size() < 127) return text + static_cast<char>(value.size()) + value;
  const std::size_t rest = value.size() - 127;
  return text + '\x7f' + static_cast<char>(rest % 128 + 128) + static_cast<char>(rest / 128) +
         value;
}

// Headers without an end, in CONTINUATION frames, before any credentials; at most 256 MiB.
void Flood(int port) {
  const RawSocket client(port);
  client.Send("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + Frame(4, 0, 0, ""));
  client.Send(Frame(1, 0, 1,
                    Literal(":method", "POST") + Literal(":scheme", "http") +
                        Literal(":path", "/homing.v1.JourneyService/GetJourney") +
                        Literal(":authority", "x")));
  std::string frames;
  for (int i = 0; i < 128; ++i) frames += Frame(9, 0, 1, Literal("x-a", std::string(8000, 'y')));
  for (int mib = 0; mib < 256 && client.Send(frames); ++mib) {
  }
}

// As operations.md has it, without TLS.
std::string NginxConfig(const TemporaryFolder& folder, int port, const std::string& server) {
  std::string paths;
  for (const char* path : {"client_body", "proxy", "fastcgi", "uwsgi", "scgi"}) {
    absl::StrAppend(&paths, path, "_temp_path ", folder.File(path), ";\n");
  }
  return absl::StrCat("daemon off; user root; pid ", folder.File("pid"), "; error_log ",
                      folder.File("errors"), ";\nevents { worker_connections 64; }\n",
                      "http { access_log off; client_max_body_size 0;\n", paths,
                      "server { listen 127.0.0.1:", port, " http2; client_body_timeout 1h;\n",
                      "location / { grpc_pass grpc://", server,
                      "; grpc_read_timeout 1h; grpc_send_timeout 1h; } } }\n");
}

void CheckHeaderFlood(const Programs& programs, Figures* figures) {
  if (::access(kNginx, X_OK) != 0) {
    std::cerr << "# nginx is not installed: no header flood behind it\n";
    return;
  }
  const TemporaryFolder folder;
  ServerUnderTest server(programs.server, folder.File(""));
  if (!server.Start({}, {"--http", "off"})) return figures->Failed("header_flood", "no server");
  const int port = RawSocket::FreePort();
  std::ofstream(folder.File("nginx.conf")) << NginxConfig(folder, port, server.address());
  Program nginx({kNginx, "-e", folder.File("errors"), "-c", folder.File("nginx.conf")});
  const std::string address = absl::StrCat("127.0.0.1:", port);
  bool ready = false;
  for (int i = 0; i < 50 && !ready; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ready = server::CheckHealth(address).ok();
  }
  const double before = FiguresOf(server.pid()).resident_mib;
  for (int i = 0; i < 8; ++i) Flood(port);
  figures->AtMost("header_flood_behind_nginx_mib", FiguresOf(server.pid()).resident_mib - before,
                  32);
  figures->Holds("header_flood_serves", ready && server::CheckHealth(address).ok());
  nginx.Signal(SIGTERM);
  nginx.Wait();
  figures->AtMost("header_flood_exit_code", server.Stop(), 0);
}

}  // namespace

void CheckSockets(const Programs& programs, Figures* figures) {
  CheckDescriptors(programs, figures);
  CheckSlowHttp(programs, figures);
  CheckHeaderFlood(programs, figures);
}

}  // namespace homing::faults
