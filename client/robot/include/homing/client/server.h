// The address of homing-server, and the credentials of this robot.
#ifndef HOMING_CLIENT_SERVER_H_
#define HOMING_CLIENT_SERVER_H_

#include <string>

namespace homing::robot {

struct Server {
  // HOST:PORT or unix:PATH. Of several servers on one database "HOST:PORT,HOST:PORT,...", or
  // "dns:///NAME:PORT" where the name has several addresses: another one takes over within seconds.
  std::string address = "127.0.0.1:50551";
  // PEM files. Any of them turns TLS on; without `tls_ca` the system's authorities are trusted.
  std::string tls_ca = "";
  std::string tls_cert = "";
  std::string tls_key = "";
  // File with a bearer token, instead of a certificate.
  std::string token_file = "";
  // Allow the token to be sent to another machine without TLS.
  bool insecure = false;
};

}  // namespace homing::robot

#endif  // HOMING_CLIENT_SERVER_H_
